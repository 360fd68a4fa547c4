#pragma once

#include <string>

namespace holdfast::apps {

/// Progress of a long command on stderr: a bar that redraws itself on a terminal, a plain line each
/// tenth otherwise.
class ProgressBar {
 public:
  explicit ProgressBar(std::string title);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `share` from 0 to 1; `note` stands behind the bar.
  void update(double share, const std::string& note = "");

 private:
  std::string title_;
  bool terminal_;
  int last_drawn_ = -1;
};

}  // namespace holdfast::apps
