#include "benchmarks/harness/child_process.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace holdfast::benchmarks {
namespace {

Error system_error(const char* what) {
  return Error{fmt::format("{}: {}", what, std::strerror(errno))};
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// The child's side: one JSON object {"answer": ...} or {"error": ...} into the pipe, then the end,
/// without the caller's destructors and buffers.
[[noreturn]] void answer_and_end(int pipe,
                                 const std::function<Result<nlohmann::ordered_json>()>& work) {
  nlohmann::ordered_json message;
  try {
    auto answer = work();
    if (answer) {
      message["answer"] = *answer;
    } else {
      message["error"] = answer.error().message;
    }
  } catch (const std::exception& exception) {
    message["error"] = exception.what();
  }
  const std::string text = message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t n = ::write(pipe, text.data() + sent, text.size() - sent);
    if (n <= 0) ::_exit(1);
    sent += static_cast<std::size_t>(n);
  }
  ::_exit(0);
}

std::string read_all(int pipe) {
  std::string text;
  char buffer[4096];
  while (true) {
    const ssize_t n = ::read(pipe, buffer, sizeof(buffer));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

Result<ChildOutcome> outcome_of(const std::string& text, int status, const rusage& usage) {
  if (WIFSIGNALED(status)) {
    return Error{fmt::format("the measuring process was ended by signal {} ({})", WTERMSIG(status),
                             ::strsignal(WTERMSIG(status)))};
  }
  auto message = nlohmann::ordered_json::parse(text, nullptr, false);
  if (message.is_discarded() || !message.is_object()) {
    return Error{
        fmt::format("the measuring process ended with code {} and no answer", WEXITSTATUS(status))};
  }
  if (message.contains("error")) return Error{message["error"].get<std::string>()};
  return ChildOutcome{message["answer"], static_cast<double>(usage.ru_maxrss) / 1024.0,
                      seconds(usage.ru_utime) + seconds(usage.ru_stime)};
}

}  // namespace

Result<ChildOutcome> run_in_child(const std::function<Result<nlohmann::ordered_json>()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) return system_error("cannot make a pipe");
  const pid_t child = ::fork();
  if (child < 0) {
    const Error error = system_error("cannot start a process");
    ::close(ends[0]);
    ::close(ends[1]);
    return error;
  }
  if (child == 0) {
    ::close(ends[0]);
    answer_and_end(ends[1], work);
  }
  ::close(ends[1]);
  const std::string text = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, 0, &usage) < 0) {
    if (errno != EINTR) return system_error("cannot wait for the measuring process");
  }
  return outcome_of(text, status, usage);
}

}  // namespace holdfast::benchmarks
