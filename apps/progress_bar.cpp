#include "apps/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace holdfast::apps {

ProgressBar::ProgressBar(std::string title)
    : title_(std::move(title)), terminal_(::isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (terminal_ && last_drawn_ >= 0) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::update(double share, const std::string& note) {
  constexpr int kWidth = 40;
  const double clamped = std::clamp(share, 0.0, 1.0);
  // A terminal is redrawn each half per cent, a file gets a line each tenth.
  const int mark = static_cast<int>(clamped * (terminal_ ? 200 : 10));
  if (mark == last_drawn_) return;
  last_drawn_ = mark;
  if (!terminal_) {
    fmt::print(stderr, "{}: {:3.0f} %{}{}\n", title_, 100 * clamped, note.empty() ? "" : "  ",
               note);
    return;
  }
  const int filled = static_cast<int>(clamped * kWidth);
  fmt::print(stderr, "\r\033[K{} [{}{}] {:3.0f} %  {}", title_, std::string(filled, '#'),
             std::string(kWidth - filled, '.'), 100 * clamped, note);
  std::fflush(stderr);
}

}  // namespace holdfast::apps
