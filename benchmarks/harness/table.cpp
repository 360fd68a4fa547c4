#include "benchmarks/harness/table.hpp"

#include <algorithm>
#include <cassert>

namespace holdfast::benchmarks {
namespace {

std::string escaped(const std::string& cell) {
  std::string text;
  for (const char c : cell) {
    if (c == '|') text += '\\';
    text += c == '\n' ? ' ' : c;
  }
  return text;
}

std::vector<std::string> escaped(std::vector<std::string> cells) {
  for (std::string& cell : cells) cell = escaped(cell);
  return cells;
}

/// Characters, not bytes, of UTF-8 text.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string text = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string space(widths[i] - width(cells[i]), ' ');
    text += ' ';
    text += i == 0 ? cells[i] + space : space + cells[i];
    text += " |";
  }
  return text + "\n";
}

std::string rule(const std::vector<std::size_t>& widths) {
  std::string text = "|";
  for (std::size_t i = 0; i < widths.size(); ++i) {
    text += std::string(widths[i] + 1, '-') + (i == 0 ? "-|" : ":|");
  }
  return text + "\n";
}

}  // namespace

Table::Table(std::vector<std::string> header) : rows_{escaped(std::move(header))} {}

void Table::add_row(std::vector<std::string> cells) {
  assert(cells.size() == rows_.front().size());
  rows_.push_back(escaped(std::move(cells)));
}

std::string Table::markdown() const {
  std::vector<std::size_t> widths(rows_.front().size(), 1);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::string text = line(rows_.front(), widths) + rule(widths);
  for (std::size_t i = 1; i < rows_.size(); ++i) text += line(rows_[i], widths);
  return text;
}

}  // namespace holdfast::benchmarks
