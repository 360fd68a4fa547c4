#include "holdfast/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <latch>

#include "holdfast/core/random.hpp"

namespace holdfast {
namespace {

/// Numbers of very different size, so that their sum shows the order of addition in its bits.
std::vector<double> uneven_numbers(std::size_t n) {
  RandomStream random(11, "uneven numbers");
  std::vector<double> numbers(n);
  for (double& x : numbers) x = random.normal() * std::exp2(random.uniform(-30, 30));
  return numbers;
}

std::uint64_t sum_bits(WorkerPool& pool, const std::vector<double>& numbers,
                       std::size_t chunk_size) {
  std::vector<double> partials;
  const double sum = ordered_sum(pool, numbers.size(), chunk_size, partials, 0.0,
                                 [&](std::size_t a, std::size_t b) {
                                   double part = 0;
                                   for (std::size_t i = a; i < b; ++i) part += numbers[i];
                                   return part;
                                 });
  return std::bit_cast<std::uint64_t>(sum);
}

TEST(OrderedSum, HasTheSameBitsWithAnyNumberOfThreadsInEveryRun) {
  const auto numbers = uneven_numbers(10'007);
  WorkerPool one(1);
  const std::uint64_t expected = sum_bits(one, numbers, 64);
  for (const int threads : {1, 2, 3, 8}) {
    WorkerPool pool(threads);
    for (int run = 0; run < 200; ++run) {
      ASSERT_EQ(sum_bits(pool, numbers, 64), expected) << threads << " threads, run " << run;
    }
  }
}

// Shows that the test above could fail: another order of addition has other bits.
TEST(OrderedSum, TheNumbersOfThisTestTellOrdersApart) {
  const auto numbers = uneven_numbers(10'007);
  WorkerPool pool(1);
  EXPECT_NE(sum_bits(pool, numbers, 64), sum_bits(pool, numbers, 63));
}

TEST(OrderedSum, OfNothingIsZero) {
  WorkerPool pool(2);
  EXPECT_EQ(sum_bits(pool, {}, 64), std::bit_cast<std::uint64_t>(0.0));
}

TEST(WorkerPool, CallsEachChunkOnceInEveryOfManyRuns) {
  for (const int threads : {1, 2, 8}) {
    WorkerPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    std::vector<int> calls(37);  // each is written by one call at a time
    for (int run = 1; run <= 2000; ++run) {
      const std::size_t chunks = static_cast<std::size_t>(run) % (calls.size() + 1);
      std::vector<int> before = calls;
      pool.run(chunks, [&](std::size_t i) { ++calls[i]; });
      for (std::size_t i = 0; i < calls.size(); ++i) {
        ASSERT_EQ(calls[i] - before[i], i < chunks ? 1 : 0) << threads << " threads, run " << run;
      }
    }
  }
}

TEST(WorkerPool, WorksInAllItsThreadsAtOnce) {
  constexpr int kThreads = 4;
  WorkerPool pool(kThreads);
  std::latch all_started(kThreads);  // nobody passes before all four chunks run
  std::atomic<int> passed = 0;
  pool.run(kThreads, [&](std::size_t) {
    all_started.arrive_and_wait();
    ++passed;
  });
  EXPECT_EQ(passed, kThreads);
}

TEST(WorkerPool, ReturnsOnlyWhenAllWorkIsDone) {
  WorkerPool pool(3);
  for (int run = 0; run < 200; ++run) {
    std::vector<std::size_t> results(64, 0);  // no atomics: a late worker would be a race
    pool.run(results.size(), [&](std::size_t i) { results[i] = i * i; });
    for (std::size_t i = 0; i < results.size(); ++i) ASSERT_EQ(results[i], i * i);
  }
}

TEST(WorkerPool, MayBeMadeAndDestroyedIdle) {
  for (int i = 0; i < 50; ++i) {
    WorkerPool pool(1 + i % 4);
    if (i % 3 == 0) pool.run(2, [](std::size_t) {});
  }
}

TEST(ForEachChunk, CoversTheRangeWithoutGapsAndOverlaps) {
  WorkerPool pool(2);
  for (const std::size_t n : {0u, 1u, 7u, 8u, 9u, 100u}) {
    std::vector<int> covered(n, 0);
    std::vector<std::size_t> begins(chunk_count(n, 8));
    for_each_chunk(pool, n, 8, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      begins[chunk] = begin;
      EXPECT_LE(end - begin, 8u);
      for (std::size_t i = begin; i < end; ++i) ++covered[i];
    });
    EXPECT_EQ(covered, std::vector<int>(n, 1));
    for (std::size_t c = 0; c < begins.size(); ++c) EXPECT_EQ(begins[c], 8 * c);
  }
}

}  // namespace
}  // namespace holdfast
