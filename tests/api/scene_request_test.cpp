#include <sys/stat.h>

#include "api/request/canonical.h"
#include "api/request/scene_spec.h"
#include "api/request/upload.h"
#include "tests/api/fixture.h"
#include "tests/support/tiny_map.h"

namespace translucube::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::string scene(const std::string& members) {
  return request_with(R"("scene":{)" + members + "}");
}
std::string mesh(const std::string& file) {
  return scene(R"("object":{"type":"mesh","file":")" + file + "\"}");
}
std::string environment_file(const std::string& file) {
  return scene(R"("environment":{"file":")" + file + "\"}");
}

constexpr std::string_view tetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
constexpr std::string_view open_tetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";

/// The shipped catalog, with a folder from which requests may name files.
class SceneFiles : public testing::Test {
 protected:
  SceneFiles() : catalog(shipped_catalog()) { catalog.file_folders = {folder.path() / "allowed"}; }

  TemporaryFolder folder;
  std::filesystem::path good = folder.write("allowed/good.obj", tetrahedron);
  std::filesystem::path secret = folder.write("secret/secret.obj", tetrahedron);
  Catalog catalog;
};

TEST(SceneRequest, PartsKeepTheDefaultsOfWhatTheyDoNotSay) {
  const RenderRequest request = accepted(scene(
      R"("object":{"radius_mm":5},"environment":{"rotation_deg":90},"camera":{"vfov_deg":60})"));
  EXPECT_EQ(std::get<SphereObject>(request.object).radius_mm, 5);
  EXPECT_EQ(std::get<NamedEnvironment>(request.environment.source).image, "forest");
  EXPECT_EQ(request.environment.rotation_deg, 90);
  EXPECT_EQ(request.environment.scale, 1);
  EXPECT_EQ(request.camera.position_mm, (std::array<double, 3>{0, 0, 90}));
  EXPECT_EQ(request.camera.vfov_deg, 60);
}

TEST(SceneRequest, TellsAllFaultsAtOnce) {
  EXPECT_THAT(pointers(scene(R"("object":{"type":"sphere","radius_mm":0,"file":"x"},)"
                             R"("environment":{"constant":[1,-1,"x"],"scale":-1},)"
                             R"("camera":{"vfov_deg":180,"up":[1,2]},"light":1)")),
              UnorderedElementsAre("/scene/object/radius_mm", "/scene/object/file",
                                   "/scene/environment/constant/1", "/scene/environment/constant/2",
                                   "/scene/environment/scale", "/scene/camera/vfov_deg",
                                   "/scene/camera/up", "/scene/light"));
}

TEST(SceneRequest, RadiusIsFromANanometreToAThousandKilometres) {
  accepted(scene(R"("object":{"type":"sphere","radius_mm":1e-6})"));
  accepted(scene(R"("object":{"type":"sphere","radius_mm":1e9})"));
  fault_at("/scene/object/radius_mm", scene(R"("object":{"radius_mm":0.99e-6})"));
  fault_at("/scene/object/radius_mm", scene(R"("object":{"radius_mm":1.01e9})"));
}

TEST(SceneRequest, ConstantEnvironmentMayBeBlack) {
  const auto environment = accepted(scene(R"("environment":{"constant":[0,0,0]})")).environment;
  EXPECT_EQ(std::get<ConstantEnvironment>(environment.source), (ConstantEnvironment{{0, 0, 0}}));
}

TEST(SceneRequest, UnknownEnvironmentTellsTheKnownOnes) {
  EXPECT_THAT(fault_at("/scene/environment/image", scene(R"("environment":{"image":"moon"})")),
              HasSubstr("forest, sunrise"));
}

TEST(SceneRequest, CameraMustLookSomewhereWithAnUp) {
  fault_at("/scene/camera", scene(R"("camera":{"target_mm":[0,0,90]})"));
  fault_at("/scene/camera/up", scene(R"("camera":{"up":[0,0,0]})"));
  fault_at("/scene/camera/up", scene(R"("camera":{"up":[0,0,-3]})"));
  // Looking down with another up is right, and so are tiny and huge vectors.
  accepted(scene(R"("camera":{"position_mm":[0,90,0],"up":[0,0,-1]})"));
  accepted(scene(R"("camera":{"up":[0,1e-300,0]})"));
  accepted(scene(R"("camera":{"up":[0,1e300,1e300]})"));
}

TEST(SceneRequest, TwoFaultsOfACameraAreBothTold) {
  EXPECT_THAT(pointers(scene(R"("camera":{"target_mm":[0,0,90],"up":[0,0,0]})")),
              UnorderedElementsAre("/scene/camera", "/scene/camera/up"));
}

TEST_F(SceneFiles, MeshInAnAllowedFolderIsTaken) {
  const RenderRequest request = accepted(mesh(good.string()), catalog);
  EXPECT_EQ(std::get<MeshRequest>(request.object).file, good.string());
  EXPECT_EQ(std::get<MeshObject>(scene_spec(request, catalog).object).file, good);
}

TEST_F(SceneFiles, MeshIsSmoothWhereTheRequestSaysSo) {
  const auto with = [&](const std::string& smooth) {
    return request_with(R"("scene":{"object":{"type":"mesh","file":")" + good.string() + '"' +
                        smooth + "}}");
  };
  const auto smooth_of = [&](const std::string& text) {
    const RenderRequest request = accepted(text, catalog);
    EXPECT_EQ(std::get<MeshObject>(scene_spec(request, catalog).object).smooth,
              std::get<MeshRequest>(request.object).smooth);
    return std::get<MeshRequest>(request.object).smooth;
  };
  EXPECT_EQ(smooth_of(with("")), std::nullopt);
  EXPECT_EQ(smooth_of(with(R"(,"smooth":true)")), true);
  EXPECT_EQ(smooth_of(with(R"(,"smooth":false)")), false);
  for (const char* wrong : {"null", "1", "\"auto\""})
    fault_at("/scene/object/smooth", with(std::string(R"(,"smooth":)") + wrong), catalog);
  for (const char* given : {"", R"(,"smooth":true)", R"(,"smooth":false)"}) {
    const std::string canonical = canonical_json(accepted(with(given), catalog));
    EXPECT_THAT(canonical, HasSubstr(*given ? given + 1 : R"("type":"mesh"})"));
    EXPECT_EQ(canonical_json(accepted(canonical, catalog)), canonical);
  }
}

TEST_F(SceneFiles, RelativePathIsRelativeToTheAllowedFolders) {
  const RenderRequest request = accepted(mesh("good.obj"), catalog);
  EXPECT_EQ(std::get<MeshRequest>(request.object).file, good.string());
  accepted(mesh("sub/../good.obj"), catalog);
}

TEST_F(SceneFiles, OutsideIsTheSameFaultWhetherTheFileIsThereOrNot) {
  const std::string there = fault_at("/scene/object/file", mesh(secret.string()), catalog);
  const std::string not_there =
      fault_at("/scene/object/file", mesh((folder.path() / "none.obj").string()), catalog);
  EXPECT_THAT(there, HasSubstr("outside the folders"));
  EXPECT_EQ(there, not_there);
  EXPECT_EQ(there, fault_at("/scene/object/file", mesh("../secret/secret.obj"), catalog));
  EXPECT_EQ(there, fault_at("/scene/object/file", mesh("../secret/none.obj"), catalog));
  EXPECT_EQ(there,
            fault_at("/scene/object/file",
                     mesh((folder.path() / "allowed/../secret/secret.obj").string()), catalog));
}

TEST_F(SceneFiles, FolderWhoseNameBeginsAlikeIsOutside) {
  const auto neighbour = folder.write("allowed-not/mesh.obj", tetrahedron);
  EXPECT_THAT(fault_at("/scene/object/file", mesh(neighbour.string()), catalog),
              HasSubstr("outside the folders"));
}

TEST_F(SceneFiles, SymbolicLinkOutOfTheFolderIsOutside) {
  std::filesystem::create_symlink(secret, folder.path() / "allowed/link.obj");
  std::filesystem::create_symlink(folder.path() / "secret", folder.path() / "allowed/link");
  for (const char* file : {"link.obj", "link/secret.obj", "link/none.obj"})
    EXPECT_THAT(fault_at("/scene/object/file", mesh(file), catalog),
                HasSubstr("outside the folders"));
}

TEST_F(SceneFiles, FilesThatCannotBeReadAreRefused) {
  EXPECT_EQ(fault_at("/scene/object/file", mesh("none.obj"), catalog), "there is no such file");
  EXPECT_THAT(fault_at("/scene/object/file", mesh("."), catalog), HasSubstr("outside"));
  std::filesystem::create_directory(folder.path() / "allowed/folder.obj");
  EXPECT_EQ(fault_at("/scene/object/file", mesh("folder.obj"), catalog), "is not a regular file");
  // Opening a pipe that nobody writes would wait for ever.
  ASSERT_EQ(mkfifo((folder.path() / "allowed/pipe.obj").c_str(), 0600), 0);
  EXPECT_EQ(fault_at("/scene/object/file", mesh("pipe.obj"), catalog), "is not a regular file");
  EXPECT_EQ(fault_at("/scene/environment/file", environment_file("pipe.obj"), catalog),
            "is not a regular file");
}

TEST_F(SceneFiles, LoopOfLinksIsRefused) {
  std::filesystem::create_symlink("b.obj", folder.path() / "allowed/a.obj");
  std::filesystem::create_symlink("a.obj", folder.path() / "allowed/b.obj");
  EXPECT_THAT(pointers(mesh("a.obj"), catalog), ElementsAre("/scene/object/file"));
}

TEST_F(SceneFiles, OpenAndEmptyMeshesAreRefused) {
  folder.write("allowed/open.obj", open_tetrahedron);
  folder.write("allowed/empty.obj", "");
  folder.write("allowed/points.obj", "v 0 0 0\nv 1 0 0\n");
  folder.write("allowed/text.obj", "this is no mesh\n");
  for (const char* file : {"open.obj", "empty.obj", "points.obj", "text.obj"})
    fault_at("/scene/object/file", mesh(file), catalog);
}

TEST_F(SceneFiles, EnvironmentFileInAnAllowedFolderIsTaken) {
  const auto file = folder.write("allowed/sky.exr", translucube::test::tiny_map);
  const RenderRequest request = accepted(environment_file("sky.exr"), catalog);
  EXPECT_EQ(std::get<FileEnvironment>(request.environment.source).file, file.string());
  const SceneSpec spec = scene_spec(request, catalog);
  EXPECT_EQ(std::get<ImageEnvironmentSpec>(spec.environment.source).file, file);
  EXPECT_EQ(fault_at("/scene/environment/file", environment_file("none.exr"), catalog),
            "there is no such file");
}

TEST_F(SceneFiles, OfWhatWasAcceptedAreNotLookedAtAgain) {
  const auto map = folder.write("allowed/sky.exr", "no picture");
  fault_at("/scene/environment/file", environment_file("sky.exr"), catalog);
  const RenderRequest request = accepted(environment_file("sky.exr"), without_limits(catalog));
  EXPECT_EQ(std::get<FileEnvironment>(request.environment.source).file, map.string());
  EXPECT_EQ(
      fault_at("/scene/environment/file", environment_file("none.exr"), without_limits(catalog)),
      "there is no such file");
}

TEST_F(SceneFiles, UploadsAreNamedByTheirHash) {
  const std::string name(64, 'a');
  const std::string upload = scene(R"("object":{"type":"mesh","upload":")" + name + R"("},)" +
                                   R"("environment":{"upload":")" + name + "\"}");
  EXPECT_THAT(fault_at("/scene/object/upload",
                       scene(R"("object":{"type":"mesh","upload":")" + name + "\"}")),
              HasSubstr("only a service has uploads"));
  catalog.uploads = folder.path() / "uploads";
  EXPECT_THAT(pointers(upload, catalog),
              UnorderedElementsAre("/scene/object/upload", "/scene/environment/upload"));
  const auto file = folder.write("uploads/meshes/" + name, "read when it was sent");
  EXPECT_THAT(pointers(upload, catalog), UnorderedElementsAre("/scene/environment/upload"));
  const auto map = folder.write("uploads/environments/" + name, "likewise");
  const RenderRequest request = accepted(upload, catalog);
  EXPECT_EQ(accepted(canonical_json(request), catalog), request);
  EXPECT_THAT(canonical_json(request), HasSubstr(R"({"type":"mesh","upload":")" + name));
  const SceneSpec spec = scene_spec(request, catalog);
  EXPECT_EQ(std::get<MeshObject>(spec.object).file, file);
  EXPECT_EQ(std::get<ImageEnvironmentSpec>(spec.environment.source).file, map);
  EXPECT_THAT(uploads_of(request, catalog), UnorderedElementsAre(file, map));
}

TEST_F(SceneFiles, CommandLineMayNameAnyFile) {
  catalog.any_file = true;
  accepted(mesh(secret.string()), catalog);
  EXPECT_EQ(fault_at("/scene/object/file", mesh((folder.path() / "none.obj").string()), catalog),
            "there is no such file");
}

TEST_F(SceneFiles, CommandLinePathIsRelativeToTheWorkingFolder) {
  catalog.any_file = true;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const RenderRequest request = accepted(mesh("secret/secret.obj"), catalog);
  std::filesystem::current_path(before);
  EXPECT_EQ(std::get<MeshRequest>(request.object).file, secret.string());
}

TEST_F(SceneFiles, CanonicalFormNamesTheFileItWasCheckedFor) {
  const RenderRequest request = accepted(mesh("good.obj"), catalog);
  EXPECT_EQ(accepted(canonical_json(request), catalog), request);
}

}  // namespace
}  // namespace translucube::api
