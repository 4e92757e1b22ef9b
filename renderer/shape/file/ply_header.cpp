#include "renderer/shape/file/ply_header.h"

#include <algorithm>

#include "renderer/shape/file/number.h"
#include "renderer/shape/triangle_mesh.h"

namespace translucube::ply {
namespace {

struct ScalarName {
  std::string_view name;
  Scalar type;
};
constexpr std::array<ScalarName, 16> scalar_names{{{"char", Scalar::int8},
                                                   {"uchar", Scalar::uint8},
                                                   {"short", Scalar::int16},
                                                   {"ushort", Scalar::uint16},
                                                   {"int", Scalar::int32},
                                                   {"uint", Scalar::uint32},
                                                   {"float", Scalar::float32},
                                                   {"double", Scalar::float64},
                                                   {"int8", Scalar::int8},
                                                   {"uint8", Scalar::uint8},
                                                   {"int16", Scalar::int16},
                                                   {"uint16", Scalar::uint16},
                                                   {"int32", Scalar::int32},
                                                   {"uint32", Scalar::uint32},
                                                   {"float32", Scalar::float32},
                                                   {"float64", Scalar::float64}}};

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : rest_(bytes) {}

  Header read() {
    if (next_line() != "ply") throw MeshError("the file does not begin with the line \"ply\"");
    while (true) {
      if (rest_.empty()) throw MeshError("the header has no line \"end_header\"");
      std::string_view line = next_line();
      const std::string_view keyword = next_word(line, " \t");
      if (keyword == "end_header") break;
      if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) continue;
      if (keyword == "format")
        read_format(line);
      else if (keyword == "element")
        read_element(line);
      else if (keyword == "property")
        read_property(line);
      else
        fail_here("is no line of a header");
    }
    if (!encoding_) throw MeshError("the header names no format");
    return {*encoding_, std::move(elements_), rest_};
  }

 private:
  [[noreturn]] void fail_here(const std::string& why) const {
    throw MeshError("line " + std::to_string(line_) + " of the header: " + why);
  }

  std::string_view next_line() {
    ++line_;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_ = end == rest_.npos ? std::string_view{} : rest_.substr(end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  void read_format(std::string_view line) {
    const std::string_view name = next_word(line, " \t");
    if (encoding_) fail_here("a second format");
    if (name == "ascii")
      encoding_ = Encoding::ascii;
    else if (name == "binary_little_endian")
      encoding_ = Encoding::little_endian;
    else if (name == "binary_big_endian")
      encoding_ = Encoding::big_endian;
    else
      fail_here("is no format of PLY");
    if (next_word(line, " \t") != "1.0") fail_here("is not version 1.0");
  }

  void read_element(std::string_view line) {
    Element element{std::string(next_word(line, " \t")), 0, {}};
    if (!is_name(element.name) || !read_integer(next_word(line, " \t"), element.count))
      fail_here("an element needs a name and a number");
    for (const Element& other : elements_)
      if (other.name == element.name) fail_here("the element " + element.name + " comes twice");
    constexpr std::size_t most = 64;
    if (elements_.size() == most) fail_here("more elements than " + std::to_string(most));
    elements_.push_back(std::move(element));
  }

  void read_property(std::string_view line) {
    if (elements_.empty()) fail_here("a property without an element");
    Property property;
    std::string_view type = next_word(line, " \t");
    if (type == "list") {
      property.count = scalar(next_word(line, " \t"));
      if (!is_integer(*property.count)) fail_here("the length of a list is an integer");
      type = next_word(line, " \t");
    }
    property.type = scalar(type);
    property.name = next_word(line, " \t");
    if (!is_name(property.name)) fail_here("a property needs a name");
    constexpr std::size_t most = 256;
    auto& properties = elements_.back().properties;
    if (properties.size() == most) fail_here("more properties than " + std::to_string(most));
    properties.push_back(std::move(property));
  }

  /// What can be told in a message.
  static bool is_name(std::string_view name) {
    constexpr std::size_t longest = 64;
    return !name.empty() && name.size() <= longest &&
           std::ranges::all_of(name, [](unsigned char c) { return c > 32 && c < 127; });
  }

  Scalar scalar(std::string_view name) const {
    const auto* found = std::ranges::find(scalar_names, name, &ScalarName::name);
    if (found == scalar_names.end()) fail_here("is no type of PLY");
    return found->type;
  }

  std::string_view rest_;
  std::uint32_t line_ = 0;
  std::optional<Encoding> encoding_;
  std::vector<Element> elements_;
};

}  // namespace

Header read_header(std::string_view bytes) { return HeaderReader(bytes).read(); }

}  // namespace translucube::ply
