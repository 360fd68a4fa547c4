#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

/// Runs the program as a user does. HOLDFAST_PROGRAM is its path, HOLDFAST_SOURCE the repository.
namespace holdfast::testing {

struct ProgramRun {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out;     ///< what it printed, errors included
};

/// `arguments` as in a shell; nothing is there to read from.
inline ProgramRun run_program(const std::string& arguments) {
  ProgramRun run;
  const std::string command = HOLDFAST_PROGRAM " " + arguments + " 2>&1 </dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return run;
  std::array<char, 4096> buffer;
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) {
    run.out.append(buffer.data(), n);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  return run;
}

}  // namespace holdfast::testing
