#pragma once

#include <functional>
#include <string>
#include <vector>

namespace translucube::bench {

/// Names in the order of their first coming.
void remember(std::vector<std::string>& names, const std::string& name);

/// A Markdown table with a row for each name and a column for each header, `cell(row, index of the
/// column)` in each. Padded, so that it reads on a terminal too.
std::string grid(const std::vector<std::string>& rows, const std::vector<std::string>& headers,
                 const std::function<std::string(const std::string&, std::size_t)>& cell);

}  // namespace translucube::bench
