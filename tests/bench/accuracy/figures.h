#pragma once

// What docs/accuracy.md is made of: figures, each measured with its standard error and, where the
// truth is known, next to it; tables of them; and the statistics that judge them.

#include <cmath>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/report/table.h"
#include "tests/bench/report/text.h"
#include "tests/support/scenes.h"

namespace translucube::accuracy {

using test::Measured;

using bench::text;

/// A known value. `error`: its standard error, 0 where it is exact. `tolerance`: how far its source
/// does not claim to be right, or a bound to keep; such a figure is held to it and has no z.
struct Truth {
  double value = 0, error = 0, tolerance = 0;
  std::string source;
};

struct Figure {
  std::string row, column;
  Measured measured;
  std::optional<Truth> truth = {};
  bool soft = false;  ///< a time: it depends on the machine
};

struct Table : bench::Table<Figure> {
  void add(std::string row, Measured measured, Truth truth) {
    figures.push_back({std::move(row), "", measured, std::move(truth)});
  }
  void add_column(std::string row, std::string column, Measured measured,
                  std::optional<Truth> truth = {}) {
    figures.push_back({std::move(row), std::move(column), measured, std::move(truth)});
  }
  void add_time(std::string row, std::string column, double value) {
    figures.push_back({std::move(row), std::move(column), {value, 0}, {}, true});
  }
};

using Report = bench::Report<Table>;

/// How much work a run does, and its random numbers: a fresh seed for each figure.
class Run {
 public:
  Run(double effort, std::uint64_t seed, int threads)
      : effort_(effort), seed_(seed), threads_(threads) {}
  int threads() const { return threads_; }
  /// Samples of a pixel, enough for four passes to tell an error by.
  std::uint32_t samples(std::uint32_t at_full_effort) const;
  int walks(int at_full_effort) const;
  /// For a standard error that falls with the root of the effort.
  double error(double at_full_effort) const { return at_full_effort / std::sqrt(effort_); }
  std::uint64_t next_seed();

 private:
  double effort_;
  std::uint64_t seed_, figures_ = 0;
  int threads_;
};

/// Films are sums of single-precision floats: exact values are met to this relative error at best.
inline constexpr double rounding = 3e-6;

/// (measured - truth) over both standard errors; empty where no chance is involved, or where the
/// truth has a tolerance.
std::optional<double> z_of(const Figure& figure);

/// |z| that the largest of so many independent ones exceeds in one run of a hundred (Sidak 1967).
double sidak_z(int figures);

/// The z of all figures at once.
struct Verdict {
  int figures = 0;         ///< with a z
  int held = 0;            ///< without one: exact, or held to a tolerance
  double threshold = 0;    ///< Sidak's
  double largest = 0;      ///< |z|
  double mean_square = 0;  ///< of z: about 1 where the standard errors are honest
  std::string where;       ///< the largest
  std::vector<std::string> disagree;
};
Verdict judge(const Report& report);

nlohmann::json to_json(const Report& report);
Report report_from_json(const nlohmann::json& json);

/// What disagrees between two runs, each figure within both standard errors (Sidak over all); times
/// are left out.
std::vector<std::string> compare(const Report& fresh, const Report& committed);

}  // namespace translucube::accuracy
