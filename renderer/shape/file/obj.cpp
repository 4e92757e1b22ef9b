#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

#include "renderer/shape/file/number.h"
#include "renderer/shape/file/polygon_mesh.h"

namespace translucube {
namespace {

// What says nothing of the surface: names, groups, materials, texture coordinates, points, lines,
// hints for display.
constexpr std::array<std::string_view, 21> passed_over{
    "vt",     "g",        "s",          "o",         "mg",    "usemtl", "mtllib",
    "usemap", "maplib",   "shadow_obj", "trace_obj", "bevel", "lod",    "l",
    "p",      "c_interp", "d_interp",   "vp",        "bsp",   "bzp",    "cdp"};
constexpr std::array<std::string_view, 14> free_form{"cstype", "deg",  "bmat", "step", "curv",
                                                     "curv2",  "surf", "parm", "trim", "hole",
                                                     "scrv",   "sp",   "con",  "call"};

class ObjParser {
 public:
  explicit ObjParser(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);  // UTF-8's byte order mark
  }

  PolygonMesh parse() {
    std::string joined;
    for (std::string_view line; next_line(line, joined);) {
      const std::string_view keyword = next_word(line);
      if (keyword.empty()) continue;
      if (keyword == "v")
        read_vertex(line);
      else if (keyword == "vn")
        read_normal(line);
      else if (keyword == "f" || keyword == "fo")  // fo: the old form
        read_face(line);
      else if (std::ranges::find(free_form, keyword) != free_form.end())
        fail("free-form curves and surfaces (" + std::string(keyword) + ") are not read");
      else if (std::ranges::find(passed_over, keyword) == passed_over.end())
        fail("\"" + printable(keyword) + "\" is no keyword of OBJ");
    }
    if (mesh_.faces() == 0) throw MeshError("the mesh has no face");
    check_exists(vertex_, "vertex", mesh_.vertices.size());
    // Where there is none, nobody meant any.
    if (!mesh_.normals.empty()) check_exists(normal_, "normal", mesh_.normals.size());
    if (normal_.line == 0 || mesh_.normals.empty()) mesh_.corner_normals.clear();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw MeshError("line " + std::to_string(line_) + ": " + why);
  }

  /// The largest index so far of vertices or of normals, which may follow the faces.
  struct Largest {
    std::uint32_t index = 0, line = 0;
    void add(std::uint32_t i, std::uint32_t in_line) {
      if (i > index || line == 0) index = i, line = in_line;
    }
  };

  void check_exists(const Largest& largest, const std::string& what, std::size_t count) {
    if (largest.line == 0 || largest.index < count) return;
    line_ = largest.line;
    fail(what + " " + std::to_string(largest.index + 1) + " does not exist: there are " +
         std::to_string(count));
  }

  /// The next line, with those that it continues on (a backslash at its end) put together in
  /// `joined`.
  bool next_line(std::string_view& line, std::string& joined) {
    line_ += more_lines_;
    more_lines_ = 0;
    joined.clear();
    while (!rest_.empty()) {
      const std::size_t end = rest_.find_first_of("\n\r");
      std::string_view piece = rest_.substr(0, end);
      const bool pair = end != rest_.npos && rest_.substr(end, 2) == "\r\n";
      rest_ = end == rest_.npos ? std::string_view{} : rest_.substr(end + (pair ? 2 : 1));
      ++more_lines_;
      piece = piece.substr(0, piece.find('#'));
      const bool goes_on = piece.ends_with('\\');  // but not in a comment
      if (goes_on) piece.remove_suffix(1);
      if (!goes_on && joined.empty()) {
        line = piece;
        break;
      }
      joined.append(piece).append(" ");
      line = joined;
      if (!goes_on) break;
    }
    if (more_lines_ == 0) return false;
    ++line_;
    --more_lines_;
    return true;
  }

  void read_vertex(std::string_view rest) {
    std::array<double, 8> numbers{};
    std::size_t count = 0;
    for (std::string_view word; !(word = next_word(rest)).empty(); ++count) {
      if (count == numbers.size()) fail("a vertex has at most eight numbers");
      if (!read_number(word, numbers[count]))
        fail("\"" + printable(word) + "\" is no finite number");
    }
    // x y z, x y z w, and either with a colour, which many programs append.
    if (count < 3) fail("a vertex needs three coordinates");
    if (count == 5) fail("a vertex of five numbers means nothing");
    if (count == 4 && numbers[3] != 1) fail("a weight of a vertex other than 1 is not read");
    if (mesh_.vertices.size() == std::numeric_limits<std::uint32_t>::max())
      fail("more vertices than can be counted");
    mesh_.vertices.push_back({numbers[0], numbers[1], numbers[2]});
  }

  /// "nan", "-inf", "-nan(ind)", "1.#IND", "1.#QNAN" and the like, in any case.
  static bool is_not_finite(std::string_view word) {
    std::string lower(word.substr(0, 16));
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::string_view number(lower);
    for (const char* name : {"nan", "inf", "ind"})
      if (number.find(name) != number.npos) return true;
    return false;
  }

  void read_normal(std::string_view rest) {
    std::array<double, 3> n{};
    bool finite = true;
    for (double& x : n) {
      const std::string_view word = next_word(rest);
      if (word.empty()) fail("a normal needs three coordinates");
      if (read_number(word, x)) continue;
      // Programs write the normal of a face without area as 0 / 0.
      if (!is_not_finite(word)) fail("\"" + printable(word) + "\" is no number");
      finite = false;
    }
    if (!next_word(rest).empty()) fail("a normal has three coordinates");
    if (mesh_.normals.size() == no_normal) fail("more normals than can be counted");
    mesh_.normals.push_back(finite ? unit_or_zero({n[0], n[1], n[2]}) : Vec3{});
  }

  void read_face(std::string_view rest) {
    std::size_t count = 0;
    for (std::string_view word; !(word = next_word(rest)).empty(); ++count) {
      const std::string_view reference = word.substr(0, word.find('/'));
      std::string_view normal;
      std::int64_t index = 0;
      if (!read_integer(reference, index) || index == 0 ||
          !read_tail(word.substr(reference.size()), normal))
        fail("\"" + printable(word) + "\" names no corner of a face");
      const std::uint32_t vertex = resolve(index, mesh_.vertices.size(), "vertex", reference);
      mesh_.corners.push_back(vertex);
      vertex_.add(vertex, line_);
      mesh_.corner_normals.push_back(no_normal);
      if (normal.empty()) continue;
      if (!read_integer(normal, index) || index == 0)
        fail("\"" + printable(word) + "\" names no corner of a face");
      mesh_.corner_normals.back() = resolve(index, mesh_.normals.size(), "normal", normal);
      normal_.add(mesh_.corner_normals.back(), line_);
    }
    if (count < 3) fail("a face needs three corners");
    mesh_.ends.push_back(mesh_.corners.size());
    mesh_.places.push_back(line_);
  }

  /// A reference as it counts from 0: those that are negative count back from the last one.
  std::uint32_t resolve(std::int64_t index, std::size_t count, const std::string& what,
                        std::string_view reference) const {
    if (index < 0) index += static_cast<std::int64_t>(count) + 1;
    if (index < 1 || index > std::numeric_limits<std::uint32_t>::max())
      fail(what + " " + printable(reference) + " does not exist");
    return static_cast<std::uint32_t>(index - 1);
  }

  /// Behind a corner's vertex: "", "/t", "/t/n" or "//n".
  static bool read_tail(std::string_view tail, std::string_view& normal) {
    for (int part = 0; part < 2 && tail.starts_with('/'); ++part) {
      tail.remove_prefix(1);
      const std::string_view number = tail.substr(0, tail.find('/'));
      std::int64_t index = 0;
      if (!number.empty() && !read_integer(number, index)) return false;
      if (part == 1) normal = number;
      tail.remove_prefix(number.size());
    }
    return tail.empty();
  }

  std::string_view rest_;
  PolygonMesh mesh_;
  std::uint32_t line_ = 0, more_lines_ = 0;
  Largest vertex_, normal_;
};

}  // namespace

PolygonMesh parse_obj(std::string_view text) { return ObjParser(text).parse(); }

}  // namespace translucube
