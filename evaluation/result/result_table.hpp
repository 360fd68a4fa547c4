#pragma once

#include <string>

#include "evaluation/evaluate.hpp"

namespace holdfast::evaluation {

/// The result as a table for a terminal, 78 columns wide; with `colours` the verdict has ANSI ones.
std::string result_table(const Evaluation& evaluation, bool colours);

}  // namespace holdfast::evaluation
