#pragma once

#include <string>
#include <vector>

#include "evaluation/report/report.hpp"
#include "evaluation/result/verdict.hpp"

namespace holdfast::evaluation {

/// One figure that the top of the page shows large.
struct Card {
  std::string label;
  std::string value;
  std::string note;
  Verdict::Light light = Verdict::Light::kNone;
};

/// The (at most six) figures that matter most: with a truth errors and shares, after an alignment
/// drift, without a truth what the run says of itself. What is not known has no card.
std::vector<Card> cards(const ReportInput& input);

struct Figure {
  std::string label;
  std::string value;
  std::string meaning;
};

struct FigureGroup {
  std::string name;
  std::vector<Figure> figures;
};

/// All figures, for the table at the end of the page.
std::vector<FigureGroup> figure_groups(const ReportInput& input);

/// Sentences about what was left out, guessed or found wrong in the log: the summary's own, or,
/// where it has none, what its counters say.
std::vector<std::string> warnings(const ReportInput& input);

}  // namespace holdfast::evaluation
