// Pictures of strangers in the formats that OpenImageIO reads, as they are stored: from memory, and
// with nothing of them decided.

#include "picture/oiio/stored.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/thread.h>

#include <mutex>

#include "picture/oiio/file.h"
#include "picture/oiio/metadata.h"
#include "picture/oiio/tags.h"

namespace translucube {
namespace {

const char* name_of(LightFormat format) {
  switch (format) {
    case LightFormat::png:
      return "png";
    case LightFormat::jpeg:
      return "jpeg";
    case LightFormat::tiff:
      return "tiff";
    default:
      throw ImageError("no format of OpenImageIO");
  }
}

void check_tags(std::span<const char> bytes, LightFormat format) {
  if (format == LightFormat::jpeg) check_jpeg_tags(bytes);
  if (format == LightFormat::tiff) check_tiff_tags(bytes);
}

/// What the file's own words say of its numbers.
void read_meaning(std::span<const char> bytes, LightFormat format, const OIIO::ImageSpec& spec,
                  StoredPicture& stored) {
  stored.orientation = spec.get_int_attribute("Orientation", 1);
  if (const OIIO::ParamValue* profile = spec.find_attribute("ICCProfile")) {
    const auto* data = static_cast<const std::uint8_t*>(profile->data());
    stored.icc_profile.assign(data, data + profile->datasize());
  }
  if (format == LightFormat::tiff) {
    stored.alpha = spec.get_int_attribute("oiio:UnassociatedAlpha") != 0 ? AlphaKind::unassociated
                                                                         : AlphaKind::associated;
  } else {
    stored.alpha = AlphaKind::unassociated;
    stored.transfer.kind = TransferCurve::Kind::srgb;
  }
  if (format == LightFormat::png) read_png_tags(bytes, stored);
  const std::string exif_space = std::string(spec.get_string_attribute("Exif:InteropIndex"));
  if (stored.icc_profile.empty() && exif_space == "R03")
    throw ImageError("is in Adobe RGB, without a profile");

  // Our own files say more.
  read_own_colorspace(metadata_of(spec).colorspace, stored);
}

}  // namespace

void prepare_stored() {
  use_one_thread();
  // OpenImageIO makes its thread pool and its table of formats when first asked for them.
  static std::once_flag once;
  std::call_once(once, [] {
    for (const LightFormat format : {LightFormat::png, LightFormat::jpeg, LightFormat::tiff})
      OIIO::ImageInput::create(name_of(format));
    OIIO::default_thread_pool();
  });
}

StoredPicture read_stored(std::span<const char> bytes, LightFormat format) {
  prepare_stored();
  check_tags(bytes, format);
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::create(name_of(format));
  if (!input || !input->set_ioproxy(&memory))
    throw ImageError("this OpenImageIO cannot read its format");
  OIIO::ImageSpec how, spec;
  how.attribute("oiio:UnassociatedAlpha", 1);  // or it is multiplied before the curve is undone
  how.attribute("oiio:RawColor", 1);
  if (!input->open("picture", spec, how))
    throw ImageError("not a readable image (" + input->geterror() + ")");
  if (spec.deep || spec.depth > 1) throw ImageError("a deep or volume image, not a flat one");
  check_size({}, spec.width, spec.height);
  check_not_cut_off(spec.width, spec.height, bytes.size());
  if (spec.nchannels <= 0 || spec.nchannels > 4)
    throw ImageError("has " + std::to_string(spec.nchannels) + " channels");
  StoredPicture stored;
  stored.width = spec.width;
  stored.height = spec.height;
  stored.channels = spec.channelnames;
  read_meaning(bytes, format, spec, stored);
  stored.samples.resize(stored.pixels() * spec.nchannels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, stored.samples.data()))
    throw ImageError("cannot be read (" + input->geterror() + ")");
  return stored;
}

}  // namespace translucube
