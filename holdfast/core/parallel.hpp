#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace holdfast {

/// A few threads that work through numbered chunks. The cut into chunks depends on the problem
/// only, never on the number of threads, so that sums taken in the order of chunks have the same
/// bits with any number of threads. With one thread everything runs in the caller.
class WorkerPool {
 public:
  /// `threads` >= 1 counts the calling thread, which works too.
  explicit WorkerPool(int threads = 1);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls work(i) once for each i in [0, chunks), in any order, and returns when all are done.
  /// `work` must not throw and must not call run() of the same pool.
  void run(std::size_t chunks, const std::function<void(std::size_t)>& work);

 private:
  void worker_loop();
  void take_chunks(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable start_;
  std::condition_variable finished_;
  const std::function<void(std::size_t)>* work_ = nullptr;
  std::size_t next_ = 0;
  std::size_t chunks_ = 0;
  std::size_t running_ = 0;
  bool stop_ = false;
  std::vector<std::thread> workers_;  // last: joined before the rest is destroyed
};

/// Number of chunks of `chunk_size` that cover `n` items.
constexpr std::size_t chunk_count(std::size_t n, std::size_t chunk_size) {
  return (n + chunk_size - 1) / chunk_size;
}

/// Calls work(chunk, begin, end) for consecutive ranges of `chunk_size` items of [0, n).
template <class Work>
void for_each_chunk(WorkerPool& pool, std::size_t n, std::size_t chunk_size, const Work& work) {
  pool.run(chunk_count(n, chunk_size), [&](std::size_t chunk) {
    const std::size_t begin = chunk * chunk_size;
    work(chunk, begin, begin + chunk_size < n ? begin + chunk_size : n);
  });
}

/// Sum over [0, n) whose bits do not depend on the number of threads: partial(begin, end) is added
/// up in the order of chunks. `partials` is the caller's buffer, so that nothing is allocated in a
/// steady state.
template <class T, class Partial>
T ordered_sum(WorkerPool& pool, std::size_t n, std::size_t chunk_size, std::vector<T>& partials,
              T zero, const Partial& partial) {
  partials.assign(chunk_count(n, chunk_size), zero);
  for_each_chunk(pool, n, chunk_size, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    partials[chunk] = partial(begin, end);
  });
  T sum = zero;
  for (const T& p : partials) sum += p;
  return sum;
}

}  // namespace holdfast
