#include <algorithm>
#include <array>
#include <limits>

#include "renderer/shape/file/number.h"
#include "renderer/shape/file/polygon_mesh.h"

namespace translucube {
namespace {

// What says nothing of the surface: names, groups, materials, texture coordinates, normals, points,
// lines, hints for display.
constexpr std::array<std::string_view, 22> passed_over{
    "vt",       "vn",       "g",          "s",         "o",     "mg",  "usemtl", "mtllib",
    "usemap",   "maplib",   "shadow_obj", "trace_obj", "bevel", "lod", "l",      "p",
    "c_interp", "d_interp", "vp",         "bsp",       "bzp",   "cdp"};
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
      else if (keyword == "f" || keyword == "fo")  // fo: the old form
        read_face(line);
      else if (std::ranges::find(free_form, keyword) != free_form.end())
        fail("free-form curves and surfaces (" + std::string(keyword) + ") are not read");
      else if (std::ranges::find(passed_over, keyword) == passed_over.end())
        fail("\"" + printable(keyword) + "\" is no keyword of OBJ");
    }
    if (mesh_.faces() == 0) throw MeshError("the mesh has no face");
    if (largest_ >= mesh_.vertices.size()) {
      line_ = largest_line_;
      fail("vertex " + std::to_string(largest_ + 1) + " does not exist: there are " +
           std::to_string(mesh_.vertices.size()));
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw MeshError("line " + std::to_string(line_) + ": " + why);
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

  void read_face(std::string_view rest) {
    std::size_t count = 0;
    for (std::string_view word; !(word = next_word(rest)).empty(); ++count) {
      const std::string_view reference = word.substr(0, word.find('/'));
      std::int64_t index = 0;
      if (!read_integer(reference, index) || index == 0 || !is_tail(word.substr(reference.size())))
        fail("\"" + printable(word) + "\" names no corner of a face");
      if (index < 0) index += static_cast<std::int64_t>(mesh_.vertices.size()) + 1;
      if (index < 1 || index > std::numeric_limits<std::uint32_t>::max())
        fail("vertex " + std::string(printable(reference)) + " does not exist");
      const auto vertex = static_cast<std::uint32_t>(index - 1);
      mesh_.corners.push_back(vertex);
      if (vertex > largest_ || mesh_.corners.size() == 1) largest_ = vertex, largest_line_ = line_;
    }
    if (count < 3) fail("a face needs three corners");
    mesh_.ends.push_back(mesh_.corners.size());
    mesh_.places.push_back(line_);
  }

  /// "", "/t", "/t/n" or "//n" behind a corner's vertex.
  static bool is_tail(std::string_view tail) {
    for (int part = 0; part < 2 && tail.starts_with('/'); ++part) {
      tail.remove_prefix(1);
      const std::string_view number = tail.substr(0, tail.find('/'));
      std::int64_t index = 0;
      if (!number.empty() && !read_integer(number, index)) return false;
      tail.remove_prefix(number.size());
    }
    return tail.empty();
  }

  std::string_view rest_;
  PolygonMesh mesh_;
  std::uint32_t line_ = 0, more_lines_ = 0;
  std::uint32_t largest_ = 0, largest_line_ = 0;
};

}  // namespace

PolygonMesh parse_obj(std::string_view text) { return ObjParser(text).parse(); }

}  // namespace translucube
