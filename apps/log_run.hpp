#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "apps/progress_bar.hpp"
#include "apps/run_options.hpp"
#include "holdfast/pipeline/methods/odometry_run.hpp"
#include "holdfast/pipeline/run_summary.hpp"
#include "holdfast/pipeline/runner.hpp"

namespace holdfast::apps {

/// A log on its way through the system, and what every command that runs on a log keeps of it: a
/// progress bar, the summary, config.yaml. Each failure ends the command.
class LogRun {
 public:
  /// Opens the log; `title` stands before the progress bar.
  LogRun(std::string log, const RunOptions& options, std::string title);

  const io::LogReader& reader() const { return *reader_; }
  const pipeline::RunSummary& summary() const { return summary_; }

  /// Plays the log through a localizer or an odometry, by the `pipeline::run` of its kind. The
  /// listener calls `add` for each scan. A log without a scan is a failure.
  template <class Method, class Listener>
  void play(Method& method, const Listener& listener);

  void add(const StepReport& report, double progress);

  /// What is known of the run by `method` without the method's own words.
  pipeline::RunSummary::About about(const std::string& method) const;

  /// config.yaml and summary.json, into the files of a run that are closed.
  template <class Files>
  void write(const pipeline::Config& config, const pipeline::RunSummary::About& about,
             Files& files) const;

 private:
  void require_scans() const;

  std::string log_;
  RunOptions options_;
  std::unique_ptr<io::LogReader> reader_;
  pipeline::RunSummary summary_;
  ProgressBar bar_;
  double elapsed_s_ = 0;
};

template <class Method, class Listener>
void LogRun::play(Method& method, const Listener& listener) {
  const auto begin = std::chrono::steady_clock::now();
  value_or_fail(pipeline::run(*reader_, method, listener));
  require_scans();
  elapsed_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <class Files>
void LogRun::write(const pipeline::Config& config, const pipeline::RunSummary::About& about,
                   Files& files) const {
  pipeline::Config written = config;
  value_or_fail(files.write("config.yaml", io::write_config(pipeline::fields_of(written))));
  value_or_fail(files.write("summary.json", summary_.json(about)));
}

}  // namespace holdfast::apps
