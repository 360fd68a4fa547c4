#pragma once

#include <CLI/CLI.hpp>

/// The subcommands of the program, one source file each. Each function adds its command with
/// options and help to `app`; when the command line names it, it runs and throws CommandFailed on
/// failure.
namespace holdfast::apps {

/// Ends the program with "error: MESSAGE" on stderr and the exit code of the contract:
/// 1 could not do it, 2 wrong usage.
struct CommandFailed {
  int exit_code;
  std::string message;
};

void add_simulate_command(CLI::App& app);
void add_map_command(CLI::App& app);
void add_localize_command(CLI::App& app);
void add_odometry_command(CLI::App& app);
void add_evaluate_command(CLI::App& app);
void add_bench_command(CLI::App& app);
void add_config_command(CLI::App& app);

}  // namespace holdfast::apps
