#include "holdfast/pipeline/runner.hpp"

#include "holdfast/pipeline/event_sequencer.hpp"

namespace holdfast::pipeline {
namespace {

Status drain(EventSequencer& sequencer, SensorSource& source, Localizer& localizer,
             const StepListener& on_step) {
  SensorEvent event;
  while (sequencer.pop(event)) {
    if (const auto* imu = std::get_if<ImuSample>(&event)) {
      localizer.add_imu(*imu);
      continue;
    }
    const StepReport report = localizer.add_scan(std::get<Scan>(event));
    if (auto heard = on_step(report, source.progress()); !heard) return heard;
  }
  return Done{};
}

}  // namespace

Status run(SensorSource& source, Localizer& localizer, const StepListener& on_step) {
  EventSequencer sequencer;
  while (true) {
    auto event = source.next();
    if (!event) return event.error();
    if (event->has_value()) {
      sequencer.push(std::move(**event));
    } else {
      sequencer.finish();
    }
    if (auto done = drain(sequencer, source, localizer, on_step); !done) return done;
    if (!event->has_value()) return Done{};
  }
}

}  // namespace holdfast::pipeline
