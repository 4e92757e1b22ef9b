# The rooms of the house, one line each: "room: rooms whose headers it may include" beside its own. Rooms stand in the
# order of their direction: a room includes only what stands above it, but for a room and its own sub-room, which is a
# part of it. Layers: server -> api -> renderer -> picture.

set(rooms
  "picture: picture/exr picture/oiio picture/sandbox"
  "picture/sandbox: picture"
  "picture/exr: picture"
  "picture/oiio: picture"
  "picture/light: picture picture/exr picture/oiio"
  "picture/sheet: picture"

  "renderer/base:"
  "renderer/shape: renderer/base renderer/shape/file renderer/shape/smooth"
  "renderer/shape/file: renderer/shape renderer/base picture/sandbox"
  "renderer/shape/smooth: renderer/shape renderer/base"
  "renderer/shape/body: renderer/shape renderer/shape/smooth renderer/base"
  "renderer/shape/file/gltf: renderer/shape renderer/base renderer/shape/file"
  "renderer/reader: renderer/shape/file picture picture/light picture/oiio picture/sandbox"
  "renderer/light: renderer/base picture"
  "renderer/optics: renderer/base renderer/light"
  "renderer/film: renderer/base renderer/optics picture"
  "renderer/scene: renderer/base renderer/shape renderer/shape/file renderer/shape/smooth renderer/shape/body renderer/light renderer/optics renderer/film picture"
  "renderer/transport: renderer/base renderer/shape renderer/light renderer/optics renderer/film renderer/scene renderer/transport/sphere renderer/transport/boundary"
  "renderer/transport/sphere: renderer/base renderer/light renderer/optics renderer/film renderer/transport"
  "renderer/transport/boundary: renderer/base renderer/shape renderer/light renderer/optics renderer/film renderer/scene renderer/transport"
  "renderer/transport/instances: renderer/transport"
  "renderer/slab: renderer/base renderer/optics renderer/film"
  "renderer: renderer/base renderer/shape renderer/shape/smooth renderer/film renderer/scene renderer/transport"

  "api/base:"
  "api/request: api/base renderer renderer/optics renderer/scene"
  "api/answer: api/base api/request renderer renderer/base renderer/film renderer/optics renderer/slab picture"
  "api:"

  "server/base: api/base picture"
  "server/store: server/base api/base api/request api/answer renderer renderer/film server/store/sqlite"
  "server/store/sqlite: server/base server/store api/answer"
  "server/pictures: server/base server/store api/base api/request api/answer renderer renderer/base renderer/film picture picture/sheet"
  "server/worker: server/base server/store server/pictures api/base api/request api/answer renderer renderer/base renderer/film renderer/light picture"
  "server/service: server/base server/store server/pictures server/worker api/base api/request api/answer picture"
  "server/http: server/base api/base picture"
  "server/calls: server/base server/service server/http api api/base api/request api/answer picture"
  "server/cli: server/base server/store server/pictures server/worker server/service server/http server/calls api/base api/request api/answer renderer renderer/film renderer/light renderer/scene picture"
)

# What the headers named by a regular expression may not be included by, in a whole layer.
set(layers picture renderer api server)
set(forbidden_picture "^(nlohmann|spdlog|CLI)/|^httplib\\.h$|^sqlite3\\.h$|^(openssl|prometheus|hwy|embree[0-9]*|Eigen)/")
set(forbidden_renderer "^(spdlog|CLI)/|^httplib\\.h$|^sqlite3\\.h$|^(openssl|prometheus)/|^(OpenImageIO|OpenColorIO|OpenEXR|Imath)/")
set(forbidden_api "^(spdlog|CLI)/|^httplib\\.h$|^sqlite3\\.h$|^(openssl|prometheus|hwy|Eigen)/|^(embree[0-9]*|OpenImageIO|OpenColorIO|OpenEXR|Imath)/")
set(forbidden_server "^httplib\\.h$|^(embree[0-9]*|OpenImageIO|OpenColorIO|OpenEXR|Imath|hwy|Eigen)/")

# Doors: the header, and the file that may include it, or the files of that name (a regular expression).
set(doors Embree OpenEXR OpenImageIO OpenColorIO LittleCMS seccomp FreeType SQLite OpenSSL prometheus
  JSON)
set(header_Embree "^embree[0-9]*/")
set(header_OpenEXR "^(OpenEXR|Imath)/|^picture/exr/file\\.h$")
set(header_OpenImageIO "^OpenImageIO/|^picture/oiio/file\\.h$")
set(header_OpenColorIO "^OpenColorIO/")
set(header_LittleCMS "^lcms2\\.h$")
set(header_seccomp "^seccomp\\.h$")
set(header_FreeType "^ft2build\\.h$|^freetype/")
set(header_SQLite "^sqlite3\\.h$")
set(header_OpenSSL "^openssl/")
set(header_prometheus "^prometheus/")
set(header_JSON "^nlohmann/")
set(door_Embree "renderer/shape/embree_mesh.cpp")
set(door_OpenEXR "picture/exr/[a-z_]+.(cpp|h)")
set(door_OpenImageIO "picture/oiio/[a-z_]+.(cpp|h)")
set(door_OpenColorIO "picture/color.cpp")
set(door_LittleCMS "picture/light/icc.cpp")
set(door_seccomp "picture/sandbox/confine.cpp")
set(door_FreeType "picture/sheet/text.cpp")
set(door_SQLite "server/store/sqlite/connection.cpp")
set(door_OpenSSL "server/(base/sha256|calls/tokens).cpp")
set(door_prometheus "server/base/metrics.cpp")
# The renderer knows JSON as a part of a format of meshes alone.
set(door_JSON "(api|server)/[a-z_0-9/]+.(cpp|h)|renderer/shape/file/gltf/[a-z_]+.(cpp|h)")
