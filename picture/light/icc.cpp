#include "picture/light/icc.h"

#include <lcms2.h>

#include <memory>
#include <vector>

#include "picture/image_io.h"
#include "picture/stored_picture.h"

namespace translucube {
namespace {

struct CloseProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
struct DeleteTransform {
  void operator()(void* transform) const { cmsDeleteTransform(transform); }
};
using Profile = std::unique_ptr<void, CloseProfile>;

Profile linear_rec709() {
  const cmsCIExyY white{rec709.white[0], rec709.white[1], 1};
  const cmsCIExyYTRIPLE primaries{{rec709.red[0], rec709.red[1], 1},
                                  {rec709.green[0], rec709.green[1], 1},
                                  {rec709.blue[0], rec709.blue[1], 1}};
  cmsToneCurve* const line = cmsBuildGamma(nullptr, 1);
  cmsToneCurve* curves[3] = {line, line, line};
  Profile profile(cmsCreateRGBProfile(&white, &primaries, curves));
  cmsFreeToneCurve(line);
  return profile;
}

}  // namespace

void apply_icc_profile(std::span<const std::uint8_t> profile, bool grey, Image& image) {
  const Profile from(
      cmsOpenProfileFromMem(profile.data(), static_cast<cmsUInt32Number>(profile.size())));
  if (!from) throw ImageError("its ICC profile cannot be read");
  const cmsColorSpaceSignature space = cmsGetColorSpace(from.get());
  if (space != (grey ? cmsSigGrayData : cmsSigRgbData))
    throw ImageError("its ICC profile is for another kind of channels");
  const Profile to = linear_rec709();
  const std::unique_ptr<void, DeleteTransform> transform(
      cmsCreateTransform(from.get(), grey ? TYPE_GRAY_FLT : TYPE_RGB_FLT, to.get(), TYPE_RGB_FLT,
                         INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE | cmsFLAGS_NOOPTIMIZE));
  if (!to || !transform) throw ImageError("its ICC profile cannot be used");
  std::vector<float> row(3 * std::size_t(image.width));
  for (int y = 0; y < image.height; ++y) {
    float* const pixels = &image.pixels[3 * std::size_t(y) * image.width];
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = pixels[i];
    if (grey)
      for (int x = 0; x < image.width; ++x) row[x] = pixels[3 * x];
    cmsDoTransform(transform.get(), row.data(), pixels, static_cast<cmsUInt32Number>(image.width));
  }
}

}  // namespace translucube
