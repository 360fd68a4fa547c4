#pragma once

#include <functional>

#include "holdfast/core/sensor_data.hpp"
#include "holdfast/core/step_report.hpp"
#include "holdfast/pipeline/localizer.hpp"

namespace holdfast::pipeline {

/// Told of each step, with the share of the log that has been read. An Error ends the run.
using StepListener = std::function<Status(const StepReport&, double progress)>;

/// Plays a source of sensor events through a localizer, in the order of end times, as fast as it
/// goes.
Status run(SensorSource& source, Localizer& localizer, const StepListener& on_step);

}  // namespace holdfast::pipeline
