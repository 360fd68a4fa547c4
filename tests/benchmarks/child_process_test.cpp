#include "benchmarks/harness/child_process.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "holdfast/core/stage_clock.hpp"

namespace holdfast::benchmarks {
namespace {

using nlohmann::ordered_json;

TEST(ChildProcess, AnswersWithoutTouchingTheCaller) {
  int touched = 0;
  const auto outcome = run_in_child([&]() -> Result<ordered_json> {
    touched = 1;
    return ordered_json{{"pid", ::getpid()}, {"long", std::string(200'000, 'x')}};
  });
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(touched, 0);
  EXPECT_NE(outcome->answer["pid"].get<pid_t>(), ::getpid());
  EXPECT_EQ(outcome->answer["long"].get<std::string>().size(), 200'000U);
}

TEST(ChildProcess, HandsErrorsAndExceptionsBack) {
  const auto refused = run_in_child([]() -> Result<ordered_json> { return Error{"no map"}; });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "no map");
  const auto thrown =
      run_in_child([]() -> Result<ordered_json> { throw std::runtime_error("out of luck"); });
  ASSERT_FALSE(thrown);
  EXPECT_EQ(thrown.error().message, "out of luck");
}

TEST(ChildProcess, ThatIsKilledOrSilentIsAnError) {
  const auto killed = run_in_child([]() -> Result<ordered_json> {
    ::raise(SIGKILL);
    return ordered_json::object();
  });
  ASSERT_FALSE(killed);
  EXPECT_NE(killed.error().message.find("signal 9"), std::string::npos) << killed.error().message;
  const auto silent = run_in_child([]() -> Result<ordered_json> { ::_exit(3); });
  ASSERT_FALSE(silent);
  EXPECT_NE(silent.error().message.find("code 3"), std::string::npos) << silent.error().message;
}

TEST(ChildProcess, HasMemoryAndTimeOfItsOwn) {
  constexpr std::size_t kMegabytes = 200;
  const auto small = run_in_child([]() -> Result<ordered_json> { return ordered_json::object(); });
  const auto large = run_in_child([]() -> Result<ordered_json> {
    std::vector<char> memory(kMegabytes << 20U);
    std::memset(memory.data(), 1, memory.size());
    const double begin = thread_cpu_ms();
    std::size_t turns = 0;
    while (thread_cpu_ms() - begin < 100) ++turns;
    return ordered_json{{"turns", turns + static_cast<std::size_t>(memory.back())}};
  });
  ASSERT_TRUE(small && large);
  EXPECT_GE(large->peak_rss_mb, static_cast<double>(kMegabytes));
  EXPECT_LT(small->peak_rss_mb, large->peak_rss_mb - 0.9 * kMegabytes);
  EXPECT_GE(large->cpu_s, 0.09);
}

}  // namespace
}  // namespace holdfast::benchmarks
