#include <cstdio>

#include "apps/commands.hpp"

int main(int argc, char** argv) {
  CLI::App app{"holdfast: LiDAR-IMU localization in a prior map", "holdfast"};
  app.require_subcommand(1);
  using namespace holdfast::apps;
  add_simulate_command(app);
  add_map_command(app);
  add_localize_command(app);
  add_odometry_command(app);
  add_evaluate_command(app);
  add_bench_command(app);
  add_config_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const CommandFailed& failure) {
    std::fprintf(stderr, "error: %s\n", failure.message.c_str());
    return failure.exit_code;
  }
  return 0;
}
