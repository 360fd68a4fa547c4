#include "holdfast/core/parallel.hpp"

#include <cassert>

namespace holdfast {

WorkerPool::WorkerPool(int threads) {
  assert(threads >= 1);
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { worker_loop(); });
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
  for (auto& worker : workers_) worker.join();
}

void WorkerPool::run(std::size_t chunks, const std::function<void(std::size_t)>& work) {
  if (workers_.empty() || chunks <= 1) {
    for (std::size_t i = 0; i < chunks; ++i) work(i);
    return;
  }
  std::unique_lock lock(mutex_);
  work_ = &work;
  next_ = 0;
  chunks_ = chunks;
  start_.notify_all();
  take_chunks(lock);
  finished_.wait(lock, [this] { return running_ == 0; });
  work_ = nullptr;
  chunks_ = 0;
}

void WorkerPool::take_chunks(std::unique_lock<std::mutex>& lock) {
  while (next_ < chunks_) {
    const std::size_t chunk = next_++;
    const auto* work = work_;
    ++running_;
    lock.unlock();
    (*work)(chunk);
    lock.lock();
    --running_;
  }
}

void WorkerPool::worker_loop() {
  std::unique_lock lock(mutex_);
  while (true) {
    start_.wait(lock, [this] { return stop_ || next_ < chunks_; });
    if (stop_) return;
    take_chunks(lock);
    if (running_ == 0) finished_.notify_one();
  }
}

}  // namespace holdfast
