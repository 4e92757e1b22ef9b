#pragma once

// What docs/speed.md is made of: figures, some with a target; tables of them.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/sampler.h"
#include "tests/bench/report/table.h"
#include "tests/bench/report/text.h"

namespace translucube::speed {

using bench::text;

/// A column of a table.
struct Quantity {
  const char* name;
  const char* format = "%.3g";
  /// How far another run of other random numbers may lie above, relative; 0 where the machine and
  /// what else it does decide, so that nothing is compared.
  double spread = 0;
};

struct Target {
  enum class Sense { at_most, at_least } sense;
  double bound;
  /// value / bound or its inverse: above 1 where the target is missed, and by how much.
  double overrun(double value) const {
    return sense == Sense::at_most ? value / bound : bound / value;
  }
  bool met(double value) const { return overrun(value) <= 1; }
};
inline Target at_most(double bound) { return {Target::Sense::at_most, bound}; }
inline Target at_least(double bound) { return {Target::Sense::at_least, bound}; }

struct Figure {
  std::string row, column;
  double value = 0;
  std::string format;
  double spread = 0;
  std::optional<Target> target;
};

struct Table : bench::Table<Figure> {
  void add(std::string row, const Quantity& quantity, double value,
           std::optional<Target> target = {});
  /// Expects that there is one.
  double value(const std::string& row, const Quantity& quantity) const;
};

/// "materials, A0, relMSE x CPU s": names a figure, in reasons.h too.
std::string name_of(const Table& table, const Figure& figure);

struct Report : bench::Report<Table> {
  int threads = 0;
  std::string machine;
};

struct Miss {
  std::string name;
  double value, overrun;
  Target target;
};
struct Verdict {
  int met = 0;
  std::vector<Miss> missed;
};
Verdict judge(const Report& report);

nlohmann::json to_json(const Report& report);
Report report_from_json(const nlohmann::json& json);

/// What has risen above the committed figures by more than its spread; times are left out.
std::vector<std::string> compare(const Report& fresh, const Report& committed);

/// How much work a run does, on what, and its random numbers.
struct Run {
  double effort = 1;
  std::uint64_t seed = 1;
  int threads = 0;                     ///< 0: all cores
  std::vector<std::string> materials;  ///< of the peers' list; empty: all
  std::uint32_t material_samples = 0;  ///< camera samples in the table of targets; 0: by effort
  std::filesystem::path sun;           ///< sunrise.exr; empty: looked for
  bool cycles = false;                 ///< render in Blender too

  /// Camera samples of a pixel, by the effort: a multiple of 4, which is a first pass.
  std::uint32_t samples(std::uint32_t at_full_effort) const;
  /// Times to repeat what is timed; odd, so that there is a median.
  int repetitions(int at_full_effort) const;
  bool chosen(const std::string& material) const;
  std::uint64_t next_seed() { return hash_combine(seed, ++seeds_); }

 private:
  std::uint64_t seeds_ = 0;
};

double median(std::vector<double> values);

}  // namespace translucube::speed
