#include "renderer/shape/file/gltf/accessor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "renderer/shape/file/gltf/data_uri.h"

namespace translucube::gltf {
namespace {

/// Types of components (specification 2.0, 3.6.2.2).
enum Component : std::uint16_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};

std::size_t size_of(Component component) {
  return component <= uint8 ? 1 : component <= uint16 ? 2 : 4;
}

double number(Component component, const char* bytes) {
  std::uint32_t bits = 0;
  for (std::size_t i = size_of(component); i-- > 0;)
    bits = bits << 8 | static_cast<unsigned char>(bytes[i]);
  switch (component) {
    case int8:
      return static_cast<std::int8_t>(bits);
    case int16:
      return static_cast<std::int16_t>(bits);
    case float32:
      return static_cast<double>(std::bit_cast<float>(bits));
    default:
      return bits;
  }
}

/// An integer as a fraction (specification 2.0, 3.11).
double fraction(Component component, double value) {
  const int bits =
      static_cast<int>(8 * size_of(component)) - (component == int8 || component == int16);
  return std::max(value / (std::ldexp(1.0, bits) - 1), -1.0);
}

Component component_of(const Value& type, std::span<const Component> allowed) {
  const std::uint64_t value = type.integer();
  std::string names;
  for (const Component component : allowed) {
    if (value == component) return component;
    names += (names.empty() ? "" : ", ") + std::to_string(component);
  }
  type.fail("must be one of " + names);
}

constexpr std::array<Component, 3> of_indices{uint8, uint16, uint32};
// Integers are KHR_mesh_quantization's.
constexpr std::array<Component, 5> of_points{float32, int8, uint8, int16, uint16};

}  // namespace

/// How elements of an accessor lie in its buffer view.
struct Accessors::Layout {
  Component component = float32;
  std::size_t components = 1;
  bool apart = false;  ///< the view may say how far apart they lie
  std::uint64_t count = 0, offset = 0;

  std::size_t element_bytes() const { return components * size_of(component); }
};

struct Accessors::Elements {
  std::vector<double> numbers;
  Component component = float32;
  bool normalized = false;
};

std::string_view Accessors::buffer(const Value& reference) {
  const Value buffer = referred(document_, "buffers", reference);
  const std::uint64_t length = buffer.at("byteLength").integer();
  std::string_view bytes;
  if (const auto uri = buffer.find("uri")) {
    // One string of the document, one buffer.
    const auto [decoded, fresh] = decoded_.try_emplace(&uri->text());
    if (fresh) {
      if (!uri->text().starts_with("data:"))
        uri->fail(
            "names another file, and only one is read: export it as GLB, or with its buffers "
            "embedded");
      auto data = bytes_of_data_uri(uri->text());
      if (!data) uri->fail("is no data: URI in base64");
      decoded->second = *std::move(data);
    }
    bytes = decoded->second;
  } else if (container_.binary && reference.integer() == 0) {
    bytes = *container_.binary;
  } else {
    buffer.fail("has no uri, and is not the binary chunk of a GLB");
  }
  if (length > bytes.size())
    buffer.at("byteLength")
        .fail("announces " + std::to_string(length) + " bytes: there are " +
              std::to_string(bytes.size()));
  return bytes.substr(0, length);
}

/// The bytes from the first element on, enough for all of them.
std::string_view Accessors::view(const Value& reference, const Layout& layout,
                                 std::uint64_t& stride) {
  const Value view = referred(document_, "bufferViews", reference);
  if (const auto extensions = view.find("extensions"))
    for (const char* packed : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
      if (extensions->has(packed))
        extensions->at(packed).fail("compressed buffers are not read: export it without meshopt");
  const std::string_view bytes = buffer(view.at("buffer"));
  const auto offset_of = [](const std::optional<Value>& offset) {
    return offset ? offset->integer() : 0;
  };
  const std::uint64_t offset = offset_of(view.find("byteOffset")),
                      length = view.at("byteLength").integer();
  if (offset + length > bytes.size())
    view.fail("reaches to byte " + std::to_string(offset + length) + " of a buffer of " +
              std::to_string(bytes.size()));
  const std::size_t element = layout.element_bytes();
  stride = element;
  if (const auto given = view.find("byteStride")) {
    if (!layout.apart) given->fail("is for vertices only");
    constexpr std::uint64_t largest_stride = 252;
    stride = given->integer(largest_stride);
    if (stride < element || stride % 4 != 0)
      given->fail("must be a multiple of 4 in [4, 252], and at least " + std::to_string(element));
  }
  const std::size_t unit = size_of(layout.component);
  if ((offset + layout.offset) % unit != 0)
    view.fail("begins, with its accessor, at no multiple of " + std::to_string(unit) + " bytes");
  const std::uint64_t end =
      layout.count == 0 ? 0 : layout.offset + (layout.count - 1) * stride + element;
  if (end > length)
    view.fail("has " + std::to_string(length) + " bytes: its accessor needs " +
              std::to_string(end));
  return bytes.substr(offset + layout.offset);
}

Accessors::Elements Accessors::elements(const Value& accessor, const Layout& wanted) {
  Layout layout = wanted;
  const std::optional<Value> view_index = accessor.find("bufferView"),
                             sparse = accessor.find("sparse"), offset = accessor.find("byteOffset");
  layout.count = accessor.at("count").integer(std::numeric_limits<std::uint32_t>::max());
  layout.offset = offset ? offset->integer() : 0;
  Elements elements{{}, layout.component, false};
  if (const auto normalized = accessor.find("normalized"))
    elements.normalized = normalized->boolean();
  if (!view_index && !sparse) accessor.fail("has neither bufferView nor sparse: it has no data");
  if (!view_index && layout.count > container_.file_bytes)
    accessor.at("count").fail("announces more elements than the file has bytes");
  std::uint64_t stride = 0;
  const std::string_view bytes =
      view_index ? view(*view_index, layout, stride) : std::string_view();
  elements.numbers.resize(layout.count * layout.components);
  for (std::uint64_t i = 0; view_index && i < layout.count; ++i)
    for (std::size_t c = 0; c < layout.components; ++c)
      elements.numbers[i * layout.components + c] =
          number(layout.component, bytes.data() + i * stride + c * size_of(layout.component));
  if (sparse) replace(*sparse, layout, elements);
  return elements;
}

/// Elements that stand elsewhere (specification 2.0, 3.6.2.3).
void Accessors::replace(const Value& sparse, const Layout& layout, Elements& elements) {
  const Value indices = sparse.at("indices"), values = sparse.at("values");
  const std::uint64_t count = sparse.at("count").integer(layout.count);
  const auto offset_of = [](const Value& part) {
    const auto offset = part.find("byteOffset");
    return offset ? offset->integer() : 0;
  };
  const Layout of_index{component_of(indices.at("componentType"), of_indices), 1, false, count,
                        offset_of(indices)};
  Layout of_value = layout;
  of_value.apart = false;
  of_value.count = count;
  of_value.offset = offset_of(values);
  std::uint64_t stride = 0;
  const std::string_view from = view(indices.at("bufferView"), of_index, stride),
                         to = view(values.at("bufferView"), of_value, stride);
  double before = -1;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double index = number(of_index.component, from.data() + i * size_of(of_index.component));
    if (index <= before || index >= static_cast<double>(layout.count))
      indices.fail("do not rise, or name an element that is not there");
    before = index;
    for (std::size_t c = 0; c < layout.components; ++c)
      elements.numbers[static_cast<std::size_t>(index) * layout.components + c] = number(
          layout.component, to.data() + i * layout.element_bytes() + c * size_of(layout.component));
  }
}

std::vector<std::uint32_t> Accessors::indices(const Value& reference) {
  const Value accessor = referred(document_, "accessors", reference);
  if (accessor.at("type").text() != "SCALAR") accessor.at("type").fail("must be SCALAR");
  const Elements all =
      elements(accessor, {component_of(accessor.at("componentType"), of_indices), 1, false, 0, 0});
  if (all.normalized) accessor.at("normalized").fail("indices are not normalized");
  std::vector<std::uint32_t> indices;
  indices.reserve(all.numbers.size());
  for (const double number : all.numbers) indices.push_back(static_cast<std::uint32_t>(number));
  return indices;
}

Accessors::Points Accessors::points(const Value& reference) {
  const Value accessor = referred(document_, "accessors", reference);
  if (accessor.at("type").text() != "VEC3") accessor.at("type").fail("must be VEC3");
  const Component component = component_of(accessor.at("componentType"), of_points);
  const Elements all = elements(accessor, {component, 3, true, 0, 0});
  const bool fractions = all.normalized && component != float32;
  Points result;
  result.points.reserve(all.numbers.size() / 3);
  for (std::size_t i = 0; i < all.numbers.size(); i += 3) {
    std::array<double, 3> p{all.numbers[i], all.numbers[i + 1], all.numbers[i + 2]};
    for (double& x : p) {
      if (!std::isfinite(x))
        accessor.fail("element " + std::to_string(i / 3) + " has a coordinate that is not finite");
      if (fractions) x = fraction(component, x);
    }
    result.points.push_back({p[0], p[1], p[2]});
  }
  // What was quantized is meant as it is.
  result.rounding = component == float32 ? 0x1p-24 : 0;
  return result;
}

}  // namespace translucube::gltf
