#pragma once

#include <cstdio>
#include <string>

namespace translucube::bench {

/// As printf; 400 characters at most.
template <class... Values>
std::string text(const char* format, Values... values) {
  char line[400];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

}  // namespace translucube::bench
