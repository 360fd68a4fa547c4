#pragma once

#include <string>
#include <vector>

namespace holdfast::benchmarks {

/// A table in Markdown that also reads well in a terminal: the first column to the left, figures to
/// the right, all cells of a column equally wide.
class Table {
 public:
  explicit Table(std::vector<std::string> header);

  /// As many cells as the header has.
  void add_row(std::vector<std::string> cells);

  /// '|' in a cell is escaped, a line break becomes a space.
  std::string markdown() const;

 private:
  std::vector<std::vector<std::string>> rows_;  ///< the header first
};

}  // namespace holdfast::benchmarks
