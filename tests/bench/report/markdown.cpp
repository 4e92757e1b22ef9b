#include "tests/bench/report/markdown.h"

#include <algorithm>

namespace translucube::bench {
namespace {

/// Characters, of UTF-8.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

void remember(std::vector<std::string>& names, const std::string& name) {
  if (!std::ranges::count(names, name)) names.push_back(name);
}

std::string grid(const std::vector<std::string>& rows, const std::vector<std::string>& headers,
                 const std::function<std::string(const std::string&, std::size_t)>& cell) {
  std::vector<std::vector<std::string>> lines{{""}};
  lines[0].insert(lines[0].end(), headers.begin(), headers.end());
  for (const std::string& row : rows) {
    lines.push_back({row});
    for (std::size_t i = 0; i < headers.size(); ++i) lines.back().push_back(cell(row, i));
  }
  std::vector<std::size_t> widths(headers.size() + 1, 3);
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], width(line[i]));
  std::string out;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    out += '|';
    for (std::size_t i = 0; i < lines[l].size(); ++i) {
      const std::string pad(widths[i] - width(lines[l][i]), ' ');
      out += i == 0 ? ' ' + lines[l][i] + pad + " |" : ' ' + pad + lines[l][i] + " |";
    }
    out += '\n';
    if (l > 0) continue;
    out += '|';
    for (std::size_t i = 0; i < widths.size(); ++i)
      out += std::string(widths[i] + 1, '-') + (i == 0 ? "-|" : ":|");
    out += '\n';
  }
  return out;
}

}  // namespace translucube::bench
