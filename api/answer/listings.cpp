#include "api/answer/listings.h"

#include <nlohmann/json.hpp>

#include "api/request/backdrop_parameters.h"
#include "api/request/object_parameters.h"

namespace translucube::api {

using nlohmann::json;

namespace {

/// A number's entry in a list of parameters; its range is closed.
template <class Number>
json number_parameter(const char* name, const char* unit, const Range& range, Number value,
                      const char* description) {
  json parameter{{"name", name},
                 {"type", std::is_integral_v<Number> ? "integer" : "number"},
                 {"minimum", static_cast<Number>(range.low)},
                 {"maximum", static_cast<Number>(range.high)},
                 {"default", value},
                 {"description", description}};
  if (unit != nullptr) parameter["unit"] = unit;
  return parameter;
}

template <std::size_t n>
json choice_parameter(const char* name, const std::array<const char*, n>& values, std::size_t value,
                      const char* description) {
  return {{"name", name},
          {"type", "string"},
          {"values", values},
          {"default", values[value]},
          {"description", description}};
}

json backdrop_part(const RenderRequest& defaults) {
  const BackdropSpec backdrop = defaults.backdrop.value_or(BackdropSpec{});
  json parameters{
      choice_parameter("type", backdrop_types, static_cast<std::size_t>(backdrop.kind),
                       "A light table shines by itself and reflects nothing; a print reflects as a "
                       "Lambertian surface what falls on it."),
      choice_parameter("pattern", pattern_names, static_cast<std::size_t>(backdrop.pattern),
                       "Squares or stripes half a period wide, or dark lines a tenth wide.")};
  for (const BackdropParameter& parameter : backdrop_parameters)
    parameters.push_back(number_parameter(parameter.name, parameter.unit, parameter.range,
                                          backdrop.*parameter.member, parameter.description));
  return {{"name", "backdrop"},
          {"description",
           "A patterned plane behind the object, without end, which hides the environment there; "
           "scene.backdrop, false for none."},
          {"parameters", std::move(parameters)}};
}

json oil_film_part(const RenderRequest& defaults) {
  const OilFilmRequest film = defaults.material.oil_film.value_or(OilFilmRequest{});
  return {{"name", "oil_film"},
          {"description",
           "A film of matching index: the surface is smooth where a point's scalar product with "
           "the normal is at least the offset; material.oil_film, false for none."},
          {"parameters",
           {{{"name", "normal"},
             {"type", "vector"},
             {"default", film.normal},
             {"description", "Towards the part that is covered; not zero."}},
            number_parameter("offset_mm", "mm", {-1e12, 1e12}, film.offset_mm,
                             "Of the border from the origin, along the normal.")}}};
}

template <class Object>
json object_json(const RenderRequest& defaults) {
  const auto* configured = std::get_if<Object>(&defaults.object);
  constexpr Object usual;
  const Object& object = configured ? *configured : usual;
  json parameters = json::array();
  for (const auto& parameter : ObjectKind<Object>::parameters) {
    const auto add = [&](auto value) {
      parameters.push_back(number_parameter(parameter.name, parameter.unit, parameter.range, value,
                                            parameter.description));
    };
    if (const auto* real = std::get_if<double Object::*>(&parameter.member))
      add(object.**real);
    else
      add(object.*std::get<std::uint64_t Object::*>(parameter.member));
  }
  return {{"name", ObjectKind<Object>::name},
          {"description", ObjectKind<Object>::description},
          {"parameters", std::move(parameters)}};
}

json upload_json(const UploadReport& upload) {
  return {{"sha256", upload.sha256}, {"bytes", upload.bytes}, {"uploaded_at", upload.uploaded_at}};
}

json uploads_json(const std::vector<UploadReport>& uploads) {
  json list = json::array();
  for (const UploadReport& upload : uploads) list.push_back(upload_json(upload));
  return list;
}

}  // namespace

std::string absorbers_json(const Catalog& catalog) {
  json list = json::array();
  for (const auto& [name, absorber] : catalog.absorbers)
    list.push_back({{"name", name},
                    {"description", absorber.description},
                    {"wavelengths_nm", absorber.spectrum.wavelengths_nm},
                    {"values", absorber.spectrum.values}});
  return json{{"absorbers", std::move(list)}}.dump();
}

std::string to_json(const UploadReport& upload) { return upload_json(upload).dump(); }

std::string environments_json(const Catalog& catalog, const std::vector<UploadReport>& uploads) {
  json list = json::array();
  for (const auto& [name, file] : catalog.environments) list.push_back({{"name", name}});
  return json{{"environments", std::move(list)}, {"uploads", uploads_json(uploads)}}.dump();
}

std::string meshes_json(const std::vector<UploadReport>& uploads) {
  return json{{"meshes", uploads_json(uploads)}}.dump();
}

std::string objects_json(const Catalog& catalog) {
  json list = json::array();
  for_each_object_kind(
      [&]<class Object>() { list.push_back(object_json<Object>(catalog.defaults)); });
  list.push_back(
      {{"name", "mesh"},
       {"description", "A closed triangle mesh."},
       {"parameters",
        {{{"name", "file"},
          {"type", "string"},
          {"description",
           "OBJ, PLY or STL in millimetres, in a folder that the service's "
           "configuration allows (none by default); or an upload."}},
         {{"name", "upload"},
          {"type", "string"},
          {"description",
           "SHA-256 of a mesh that was sent to PUT /v1/meshes/{sha256}; or a file."}},
         {{"name", "smooth"},
          {"type", "boolean"},
          {"description",
           "Whether its triangles stand for a curved surface. Not given: if the file has normals "
           "that say so."}}}}});
  return json{{"objects", std::move(list)},
              {"backdrop", backdrop_part(catalog.defaults)},
              {"oil_film", oil_film_part(catalog.defaults)}}
      .dump();
}

std::string displays_json(const std::vector<Display>& displays) {
  json list = json::array();
  for (const Display& display : displays)
    list.push_back({{"name", display.name}, {"views", display.views}});
  return json{{"displays", std::move(list)}}.dump();
}

}  // namespace translucube::api
