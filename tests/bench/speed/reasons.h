#pragma once

// Why targets are missed, written by people after a look at the figures; docs/speed.md tells it
// beside the figure.

#include <string>

namespace translucube::speed {

struct Reason {
  const char* figure;  ///< "table, row, quantity" or "table, row" or "table"
  const char* why;
};
inline constexpr Reason reasons[] = {
    {"", ""},
};

/// The most specific reason for a missed figure; empty where nobody has written one.
inline std::string reason_for(const std::string& name) {
  std::string why;
  std::size_t longest = 0;
  for (const Reason& reason : reasons) {
    const std::string figure = reason.figure;
    const bool covers = name == figure || name.starts_with(figure + ", ");
    if (!figure.empty() && covers && figure.size() > longest) {
      longest = figure.size();
      why = reason.why;
    }
  }
  return why;
}

}  // namespace translucube::speed
