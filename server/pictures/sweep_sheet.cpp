#include "server/pictures/sweep_sheet.h"

#include "api/answer/sweep_status.h"

namespace translucube::server {
namespace {

SheetSpec spec_of(const api::Sweep& sweep, std::int64_t max_pixels) {
  SheetSpec spec;
  spec.axes[0] = {"absorption a", number_labels(sweep.absorption)};
  spec.axes[1] = {"roughness r", number_labels(sweep.roughness)};
  spec.axes[2] = {"scattering s", number_labels(sweep.scattering)};
  for (std::size_t i = 0; i < sweep.absorbers.size(); ++i)
    spec.axes[3].labels.push_back(api::absorber_label(sweep, i));
  spec.picture_width = sweep.base.width;
  spec.picture_height = sweep.base.height;
  spec.max_pixels = max_pixels;
  return spec;
}

SheetLook look_of(const ImageForm& form, const ColorConfig& colors) {
  return is_scene_linear(form.format) ? scene_linear_look()
                                      : display_look(colors, form.display, form.view);
}

}  // namespace

SweepSheet::SweepSheet(const api::Sweep& sweep, const ImageForm& form, const ColorConfig& colors,
                       std::int64_t max_pixels)
    : sweep_(sweep),
      form_(form),
      colors_(colors),
      font_(find_font()),
      sheet_(lay_out_sheet(spec_of(sweep, max_pixels), font_), font_, look_of(form, colors)) {}

SheetCell SweepSheet::cell(std::size_t point) const {
  const api::SweepPlace place = api::place_of(sweep_, point);
  return {static_cast<int>(place.absorption), static_cast<int>(place.roughness),
          static_cast<int>(place.scattering), static_cast<int>(place.absorber)};
}

void SweepSheet::place(std::size_t point, const Image& picture) {
  sheet_.place(cell(point), picture);
}

void SweepSheet::mark(std::size_t point, std::string_view state) {
  sheet_.mark(cell(point), state);
}

void SweepSheet::write(const std::filesystem::path& file,
                       const std::string& canonical_sweep) const {
  if (!is_scene_linear(form_.format)) {
    write_image(file, sheet_.image(), form_.format,
                {canonical_sweep, form_.display + '/' + form_.view});
    return;
  }
  Image image = sheet_.image();
  if (form_.colorspace != "lin_rec709") colors_.apply_colorspace(image, form_.colorspace);
  write_image(file, image, form_.format, {canonical_sweep, form_.colorspace});
}

}  // namespace translucube::server
