// Colour management through OpenColorIO 2.1: the only file that includes it.

#include "picture/color.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <initializer_list>
#include <map>
#include <mutex>
#include <utility>

namespace translucube {

namespace ocio = OCIO_NAMESPACE;

namespace {

// Between our spaces and ACES2065-1, the interchange space of OpenColorIO configs: derived as
// config/display.ocio says (D65 and the ACES white, Bradford), row-major 4 x 4.
using Matrix4 = std::array<double, 16>;
constexpr Matrix4 rec709_from_aces = {2.521686186744,
                                      -1.13413098824,
                                      -0.387555198504,
                                      0,  //
                                      -0.27647991423,
                                      1.372719087668,
                                      -0.096239173438,
                                      0,  //
                                      -0.015378064966,
                                      -0.152975335867,
                                      1.168353400833,
                                      0,  //
                                      0,
                                      0,
                                      0,
                                      1};
constexpr Matrix4 acescg_from_aces = {1.451439316146,
                                      -0.236510746894,
                                      -0.214928569252,
                                      0,  //
                                      -0.076553773396,
                                      1.176229699834,
                                      -0.099675926438,
                                      0,  //
                                      0.008316148426,
                                      -0.006032449791,
                                      0.997716301365,
                                      0,  //
                                      0,
                                      0,
                                      0,
                                      1};
constexpr Matrix4 xyz_from_aces = {0.938279849277,
                                   -0.004451445812,
                                   0.016627523587,
                                   0,  //
                                   0.337368890788,
                                   0.72952156669,
                                   -0.066890457478,
                                   0,  //
                                   0.00117395085,
                                   -0.003710706402,
                                   1.091594506312,
                                   0,  //
                                   0,
                                   0,
                                   0,
                                   1};

/// A scene-linear space that the service names, and where another config may have it.
struct SceneSpace {
  std::string name;
  std::initializer_list<const char*> names;  ///< names or aliases, first match wins
  Matrix4 from_aces;                         ///< used where the config has no such space
};

const std::array<SceneSpace, 3> scene_spaces = {{
    {"lin_rec709",
     {"lin_rec709", "Linear Rec.709 (sRGB)", "Utility - Linear - Rec.709",
      "Utility - Linear - sRGB"},
     rec709_from_aces},
    {"ACEScg", {"ACEScg", "ACES - ACEScg"}, acescg_from_aces},
    {"XYZ", {"XYZ", "lin_xyz_d65"}, xyz_from_aces},
}};

ocio::MatrixTransformRcPtr matrix(const Matrix4& values, ocio::TransformDirection direction) {
  auto transform = ocio::MatrixTransform::Create();
  transform->setMatrix(values.data());
  transform->setDirection(direction);
  return transform;
}

std::vector<Display> list_displays(const ocio::Config& config) {
  std::vector<Display> displays;
  for (int d = 0; d < config.getNumDisplays(); ++d) {
    Display display{config.getDisplay(d), {}};
    for (int v = 0; v < config.getNumViews(display.name.c_str()); ++v)
      display.views.emplace_back(config.getView(display.name.c_str(), v));
    const auto first = std::find(display.views.begin(), display.views.end(),
                                 std::string(config.getDefaultView(display.name.c_str())));
    if (first != display.views.end()) std::rotate(display.views.begin(), first, first + 1);
    displays.push_back(std::move(display));
  }
  const auto first = std::find_if(displays.begin(), displays.end(), [&](const Display& d) {
    return d.name == config.getDefaultDisplay();
  });
  if (first != displays.end()) std::rotate(displays.begin(), first, first + 1);
  return displays;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text;
}

}  // namespace

struct ColorConfig::Impl {
  ocio::ConstConfigRcPtr config;
  std::vector<Display> displays;
  std::map<std::string, std::string> space_in_config;  ///< by our name; absent: through ACES

  std::mutex mutex;
  std::map<std::pair<std::string, std::string>, ocio::ConstCPUProcessorRcPtr> processors;

  /// Appends what leads from our linear Rec.709 to the first space that the config knows; returns
  /// the space's name.
  std::string append_source(ocio::GroupTransform& group) const {
    if (const auto found = space_in_config.find("lin_rec709"); found != space_in_config.end())
      return found->second;
    group.appendTransform(matrix(rec709_from_aces, ocio::TRANSFORM_DIR_INVERSE));
    return ocio::ROLE_INTERCHANGE_SCENE;
  }

  ocio::ConstTransformRcPtr display_transform(const std::string& display,
                                              const std::string& view) const {
    auto group = ocio::GroupTransform::Create();
    auto transform = ocio::DisplayViewTransform::Create();
    transform->setSrc(append_source(*group).c_str());
    transform->setDisplay(display.c_str());
    transform->setView(view.c_str());
    group->appendTransform(transform);
    return group;
  }

  ocio::ConstTransformRcPtr space_transform(const SceneSpace& space) const {
    auto group = ocio::GroupTransform::Create();
    const auto found = space_in_config.find(space.name);
    if (found != space_in_config.end()) {
      const std::string source = append_source(*group);
      auto transform = ocio::ColorSpaceTransform::Create();
      transform->setSrc(source.c_str());
      transform->setDst(found->second.c_str());
      group->appendTransform(transform);
    } else {
      group->appendTransform(matrix(rec709_from_aces, ocio::TRANSFORM_DIR_INVERSE));
      group->appendTransform(matrix(space.from_aces, ocio::TRANSFORM_DIR_FORWARD));
    }
    return group;
  }

  /// Applies what `make_transform` makes; its processor is made once for each key.
  template <typename MakeTransform>
  void apply(Image& image, const std::pair<std::string, std::string>& key,
             MakeTransform make_transform) {
    assert(image.pixels.size() == std::size_t{3} * image.width * image.height);
    if (image.pixels.empty()) return;
    try {
      ocio::ConstCPUProcessorRcPtr processor;
      {
        const std::lock_guard lock(mutex);
        auto& cached = processors[key];
        // Lossless: the fast approximation of pow() is visible in 16 bits.
        if (!cached)
          cached = config->getProcessor(make_transform())
                       ->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
        processor = cached;
      }
      ocio::PackedImageDesc pixels(image.pixels.data(), image.width, image.height, 3);
      processor->apply(pixels);
    } catch (const ocio::Exception& error) {
      throw ColorError(std::string("colour conversion failed: ") + error.what());
    }
  }
};

ColorConfig::ColorConfig(const std::filesystem::path& config) : impl_(std::make_unique<Impl>()) {
  const char* const environment = std::getenv("OCIO");
  const std::string file = environment && *environment ? environment : config.string();
  try {
    impl_->config = ocio::Config::CreateFromFile(file.c_str());
    impl_->config->validate();
    impl_->displays = list_displays(*impl_->config);
  } catch (const ocio::Exception& error) {
    throw ColorError("OpenColorIO config " + file + ": " + error.what());
  }
  if (impl_->displays.empty()) throw ColorError("OpenColorIO config " + file + " has no display");

  std::vector<std::string> missing;
  for (const SceneSpace& space : scene_spaces) {
    const auto found = std::find_if(space.names.begin(), space.names.end(), [&](const char* n) {
      return impl_->config->getColorSpace(n) != nullptr;
    });
    if (found != space.names.end())
      impl_->space_in_config[space.name] = *found;
    else
      missing.push_back(space.name);
  }
  if (!missing.empty() && !impl_->config->hasRole(ocio::ROLE_INTERCHANGE_SCENE))
    throw ColorError("OpenColorIO config " + file + " lacks the scene-linear colour space " +
                     listed(missing) + " (a colour space of that name or alias), and the role \"" +
                     ocio::ROLE_INTERCHANGE_SCENE + "\" through which it could be reached");
}

ColorConfig::~ColorConfig() = default;
ColorConfig::ColorConfig(ColorConfig&&) noexcept = default;

const std::vector<Display>& ColorConfig::displays() const { return impl_->displays; }

void ColorConfig::apply_display(Image& image, const std::string& display,
                                const std::string& view) const {
  std::vector<std::string> names;
  for (const Display& d : impl_->displays) {
    names.push_back(d.name);
    if (d.name != display) continue;
    if (std::find(d.views.begin(), d.views.end(), view) == d.views.end())
      throw ColorError("display \"" + display + "\" has no view \"" + view + "\", only " +
                       listed(d.views));
    impl_->apply(image, {display, view}, [&] { return impl_->display_transform(display, view); });
    return;
  }
  throw ColorError("no display \"" + display + "\", only " + listed(names));
}

void ColorConfig::apply_colorspace(Image& image, const std::string& colorspace) const {
  std::vector<std::string> names;
  for (const SceneSpace& space : scene_spaces) {
    names.push_back(space.name);
    if (space.name != colorspace) continue;
    if (space.name != "lin_rec709")
      impl_->apply(image, {colorspace, ""}, [&] { return impl_->space_transform(space); });
    return;
  }
  throw ColorError("no colour space \"" + colorspace + "\", only " + listed(names));
}

}  // namespace translucube
