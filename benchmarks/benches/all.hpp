#pragma once

#include "benchmarks/bench.hpp"

/// The benches, one file each. A new one is declared here and listed in benchmarks/bench.cpp.
namespace holdfast::benchmarks {

/// Step time of the default localizer in the corridor, the office and the hall (16 x 1800 LiDAR),
/// and in the office with 128 x 1024, beside three yardsticks on the same scans in the same run:
/// map_filter alone, a k-d-tree registration with fits at query time from map_filter's predicted
/// poses, and plain reading of the log. All on one thread, as thread CPU time; `threads` serves the
/// simulation only.
Result<BenchReport> measure_step(const BenchOptions& options);

/// Errors of the localizer over worlds and seeds; each drive in its own survey of its world.
/// `threads` drives run at a time, each on one thread.
Result<BenchReport> measure_accuracy(const BenchOptions& options);

/// All scenarios over seeds, as they are, in a changed world, and with each event; streamed,
/// without a log on disk. What is done stands in options.out / "scenarios.drives.jsonl", and is not
/// done again. `threads` places are driven through at a time, each on one thread.
Result<BenchReport> measure_scenarios(const BenchOptions& options);

/// The monitor as a detector of wrong poses, beside the article's (Tables 7 and 8): drives in which
/// nothing happens, in which something happens that is no reason for an alarm, kidnaps and wrong
/// starts, over scenarios and seeds. Missed events, time to alarm, false alarms, what each
/// threshold would give, and whether the probability means something. `threads` places are driven
/// through at a time, each on one thread.
Result<BenchReport> measure_detection(const BenchOptions& options);

/// Kidnaps, instant and carried, and starts without a pose, over scenarios and seeds, in worlds as
/// surveyed and changed: how many the whole system makes up for in 3 s, how soon, and how often it
/// takes a pose over that is wrong. `threads` places are driven through at a time, each on one
/// thread (and one for its searches).
Result<BenchReport> measure_relocalization(const BenchOptions& options);

/// The global search alone, at random moments of drives, in worlds as surveyed and changed, with
/// one scan and with six: how often it finds the pose, a wrong one, or none; time and work.
/// `threads` places are driven through at a time, each on one thread.
Result<BenchReport> measure_search(const BenchOptions& options);

/// The campus in one drive of its whole way (at most `duration_s` of it), in its own survey: errors
/// and claims by its regions. `threads` cast rays and fit surfaces; the localizer has one.
Result<BenchReport> measure_regions(const BenchOptions& options);

/// Making a map of 2 million points and localizing in it, each in a process of its own, so that the
/// peak memory is its own. `threads` fit the surfaces.
Result<BenchReport> measure_import(const BenchOptions& options);

/// Speed of the simulator for a 16 x 1800 LiDAR.
Result<BenchReport> measure_simulator(const BenchOptions& options);

/// Features by `printed`, `log` and `fitted` in the simulated worlds: how many, how many of them
/// right by the simulator's true edges and normals, how many of what is there found, and the time
/// of a scan on one thread. `threads` serves the simulation only.
Result<BenchReport> measure_features(const BenchOptions& options);

/// Table 1 of the article: how far points lie from the surfaces they were measured on, as they
/// come, deskewed with the IMU and the state of the running localizer, and placed by the true
/// poses; on straights and in turns; and the errors of the localizer with and without deskewing.
/// `threads` drives run at a time, each on one thread.
Result<BenchReport> measure_deskew(const BenchOptions& options);

/// The odometry alone over worlds and seeds: drift over 10, 20 and 50 m, consistency of its
/// increments, time and memory. `threads` drives run at a time, each on one thread.
Result<BenchReport> measure_odometry(const BenchOptions& options);

/// Whether the pose covariance that map_filter and the graph report is that of their errors: NEES
/// by axis of the body and the share of instants in its band, over worlds and seeds, each drive in
/// a survey of its own. A setting `method=...` leaves the other method out. `threads` drives run at
/// a time, each on one thread.
Result<BenchReport> measure_consistency(const BenchOptions& options);

/// Table 7 of the article: errors of the whole system and of it without one part at a time, on the
/// same drives. `threads` drives run at a time, each on one thread.
Result<BenchReport> measure_ablation(const BenchOptions& options);

}  // namespace holdfast::benchmarks
