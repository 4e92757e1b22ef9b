// Uploads over a real socket: what is kept is what its name says, whatever clients send.

#include <sys/stat.h>

#include <thread>

#include "api/base/text.h"
#include "tests/server/calls/contract_service.h"
#include "tests/server/http/wire.h"
#include "tests/server/tiny_uploads.h"

namespace translucube::server::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::string name_of(const std::string& bytes) { return hex(sha256(bytes)); }
std::string path_of(const std::string& bytes) { return "/v1/meshes/" + name_of(bytes); }

std::string head(const std::string& path, const std::string& fields) {
  return "PUT " + path + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n";
}

struct UploadCalls : testing::Test {
  explicit UploadCalls(ServiceOptions options = {}) : live(contract, std::move(options)) {}

  Answer put(const std::string& bytes) {
    return live.caller.send("PUT", path_of(bytes), {}, bytes);
  }
  /// What lies in the folder of uploads beside its two folders.
  std::vector<fs::path> half_written() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(live.service.data.uploads()))
      if (!entry.is_directory()) files.push_back(entry.path());
    return files;
  }
  std::size_t kept() { return live.caller.send("GET", "/v1/meshes").value()["meshes"].size(); }

  Contract contract;
  Live live;
};

TEST_F(UploadCalls, KeepAFileUnderItsName) {
  const Answer first = put(tetrahedron);
  EXPECT_EQ(first.status, 201) << first.body;
  EXPECT_EQ(first.value()["sha256"], name_of(tetrahedron));
  EXPECT_EQ(first.value()["bytes"], tetrahedron.size());
  const Answer again = put(tetrahedron);
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(again.body, first.body);
  EXPECT_EQ(read_file(live.service.data.uploads() / "meshes" / name_of(tetrahedron)), tetrahedron);
  EXPECT_THAT(half_written(), IsEmpty());
}

TEST_F(UploadCalls, TakeChunksAndAnyCut) {
  Wire wire(live.served.port());
  wire.send(head(path_of(tetrahedron), "Transfer-Encoding: chunked\r\n"));
  for (const char byte : tetrahedron) wire.send(std::string("1\r\n") + byte + "\r\n");
  wire.send("0\r\n\r\n");
  EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 201"));
  // The connection goes on.
  wire.send(head(path_of(tetrahedron), "Content-Length: " + std::to_string(tetrahedron.size()) +
                                           "\r\nExpect: 100-continue\r\n"));
  EXPECT_THAT(wire.receive_some(), StartsWith("HTTP/1.1 100"));
  wire.send(tetrahedron);
  EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 200"));
}

TEST_F(UploadCalls, RefuseWhatIsNotWhatItsNameSays) {
  const Answer other = live.caller.send("PUT", path_of(tetrahedron), {}, tetrahedron_of(1));
  EXPECT_EQ(other.status, 422);
  EXPECT_THAT(other.body, HasSubstr(name_of(tetrahedron_of(1))));
  const Answer open = put("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(open.status, 422);
  EXPECT_THAT(open.body, HasSubstr("not closed"));
  EXPECT_EQ(put("").status, 422);
  EXPECT_EQ(put(tiny_map).status, 422);
  const std::vector<std::string> no_names{"x", "..%2F..%2Fx", name_of("").substr(1),
                                          name_of("") + "0"};
  for (const std::string& name : no_names)
    EXPECT_EQ(live.caller.send("PUT", "/v1/meshes/" + name, {}, tetrahedron).status, 422) << name;
  std::string upper = name_of(tetrahedron);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(live.caller.send("PUT", "/v1/meshes/" + upper, {}, tetrahedron).status, 422);
  EXPECT_EQ(kept(), 0u);
  EXPECT_THAT(half_written(), IsEmpty());
}

TEST_F(UploadCalls, LeaveNothingOfABodyThatIsCutOff) {
  const std::string length = "Content-Length: " + std::to_string(tetrahedron.size()) + "\r\n";
  {
    Wire wire(live.served.port());
    wire.send(head(path_of(tetrahedron), length) + tetrahedron.substr(0, 40));
    EXPECT_TRUE(eventually([&] { return half_written().size() == 1; }));
    wire.end_sending();
    EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 400"));
  }
  {
    Wire gone(live.served.port());
    gone.send(head(path_of(tetrahedron), length) + tetrahedron.substr(0, 40));
    EXPECT_TRUE(eventually([&] { return half_written().size() == 1; }));
  }
  EXPECT_TRUE(eventually([&] { return half_written().empty(); }));
  EXPECT_EQ(kept(), 0u);
  EXPECT_EQ(put(tetrahedron).status, 201);
}

TEST_F(UploadCalls, AreBoundedInSizeHoweverItIsTold) {
  const std::string large((1 << 20) + 1, ' ');
  EXPECT_EQ(put(large).status, 413);
  Wire wire(live.served.port());
  wire.send(head(path_of(large), "Transfer-Encoding: chunked\r\n"));
  wire.send("100001\r\n" + large + "\r\n0\r\n\r\n");
  EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 413"));
  Wire lies(live.served.port());
  lies.send(head(path_of(large), "Content-Length: 99999999999\r\n"));
  EXPECT_THAT(lies.receive(), StartsWith("HTTP/1.1 413"));
  EXPECT_TRUE(eventually([&] { return half_written().empty(); }));
}

TEST_F(UploadCalls, OfOneFileAtOnceKeepItOnce) {
  std::atomic<int> created = 0, there = 0;
  {
    std::vector<std::jthread> clients;
    for (int i = 0; i < 3; ++i)
      clients.emplace_back([&] {
        httplib::Client client("127.0.0.1", live.served.port());
        client.set_read_timeout(120);
        const auto answer = client.Put(path_of(tetrahedron), tetrahedron, "model/obj");
        ASSERT_TRUE(answer);
        created += answer->status == 201;
        there += answer->status == 200;
      });
  }
  EXPECT_EQ(created, 1);
  EXPECT_EQ(there, 2);
  EXPECT_EQ(kept(), 1u);
}

TEST_F(UploadCalls, HaveSoManyPlaces) {
  const std::string length = "Content-Length: " + std::to_string(tetrahedron.size()) + "\r\n";
  std::vector<std::unique_ptr<Wire>> wires;
  for (int i = 0; i < live.service.config.uploads; ++i) {
    wires.push_back(std::make_unique<Wire>(live.served.port()));
    wires.back()->send(head(path_of(tetrahedron), length) + "v");
  }
  EXPECT_TRUE(eventually([&] { return half_written().size() == wires.size(); }));
  EXPECT_EQ(put(tetrahedron).status, 503);
  wires.clear();
  EXPECT_TRUE(eventually([&] { return put(tetrahedron).status == 201; }));
}

TEST_F(UploadCalls, AreWhatRequestsName) {
  const auto request = [](const std::string& mesh, const std::string& map) {
    json document = json::parse(small_request(4));
    document["scene"]["object"] = {{"type", "mesh"}, {"upload", mesh}};
    document["scene"]["environment"] = {{"upload", map}};
    return document.dump();
  };
  const auto post = [&](const std::string& body) {
    return live.caller.send("POST", "/v1/renders", {}, body);
  };
  const Answer unknown = post(request(name_of(tetrahedron), name_of(tiny_map)));
  EXPECT_EQ(unknown.status, 422);
  ASSERT_EQ(unknown.value()["errors"].size(), 2u) << unknown.body;
  EXPECT_EQ(unknown.value()["errors"][0]["pointer"], "/scene/object/upload");
  EXPECT_EQ(unknown.value()["errors"][1]["pointer"], "/scene/environment/upload");
  EXPECT_EQ(post(request("../jobs.sqlite", "x")).status, 422);
  put(tetrahedron);
  live.caller.send("PUT", "/v1/environments/" + name_of(tiny_map), {}, tiny_map);
  const Answer known = post(request(name_of(tetrahedron), name_of(tiny_map)));
  ASSERT_EQ(known.status, 202) << known.body;
  EXPECT_EQ(known.value()["request"]["scene"]["object"],
            (json{{"type", "mesh"}, {"upload", name_of(tetrahedron)}}));
  EXPECT_EQ(live.service.wait(known.value()["id"]).state, api::JobState::succeeded);
  // Another file, another picture.
  put(tetrahedron_of(1));
  const std::string first = live.service.content(known.value()["id"]);
  const Answer other = post(request(name_of(tetrahedron_of(1)), name_of(tiny_map)));
  EXPECT_NE(live.service.content(other.value()["id"]), first);
  // A mesh is no light.
  EXPECT_EQ(post(request(name_of(tetrahedron), name_of(tetrahedron))).status, 422);
}

TEST_F(UploadCalls, ThatAreLostAreWaitedFor) {
  std::atomic<bool> go_on = false;
  live.renderer.before_pass = [&](const Pass&) {
    while (!go_on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  live.caller.send("POST", "/v1/renders", {}, small_request(4, 7));
  put(tetrahedron);
  json render = json::parse(small_request(4));
  render["scene"]["object"] = {{"type", "mesh"}, {"upload", name_of(tetrahedron)}};
  const std::string id = live.caller.send("POST", "/v1/renders", {}, render.dump()).value()["id"];
  fs::remove(live.service.data.uploads() / "meshes" / name_of(tetrahedron));
  go_on = true;
  EXPECT_TRUE(eventually([&] { return live.service.service.figures().set_back == 1; }));
  EXPECT_EQ(put(tetrahedron).status, 201);
  EXPECT_EQ(live.service.wait(id).state, api::JobState::succeeded);
}

struct FewUploads : UploadCalls {
  // Each counts 64 KiB.
  FewUploads() : UploadCalls(options()) {}
  static ServiceOptions options() {
    ServiceOptions few;
    few.workers = 0;
    few.keep_days = 2;
    few.upload_quota_bytes = 2 << 16;
    return few;
  }
  void age(const std::string& bytes, int days) {
    const auto then = std::time(nullptr) - days * 86'400;
    const timespec times[2] = {{then, 0}, {then, 0}};
    EXPECT_EQ(::utimensat(AT_FDCWD, file(bytes).c_str(), times, 0), 0);
  }
  fs::path file(const std::string& bytes) const {
    return live.service.data.uploads() / "meshes" / name_of(bytes);
  }
};

TEST_F(FewUploads, StayWhereTheirQuotaIsFull) {
  EXPECT_EQ(put(tetrahedron_of(1)).status, 201);
  EXPECT_EQ(put(tetrahedron_of(2)).status, 201);
  EXPECT_EQ(put(tetrahedron_of(3)).status, 507);
  age(tetrahedron_of(1), 1);  // not long enough
  EXPECT_EQ(put(tetrahedron_of(3)).status, 507);
  EXPECT_EQ(kept(), 2u);
}

TEST_F(FewUploads, ThatNobodyUsedForLongGiveWay) {
  for (const int number : {1, 2}) put(tetrahedron_of(number));
  age(tetrahedron_of(1), 4);
  age(tetrahedron_of(2), 3);
  EXPECT_EQ(put(tetrahedron_of(3)).status, 201);
  EXPECT_FALSE(fs::exists(file(tetrahedron_of(1))));
  EXPECT_TRUE(fs::exists(file(tetrahedron_of(2))));
}

TEST_F(FewUploads, ThatARenderWaitsForStay) {
  for (const int number : {1, 2}) put(tetrahedron_of(number));
  json render = json::parse(small_request(4));
  render["scene"]["object"] = {{"type", "mesh"}, {"upload", name_of(tetrahedron_of(1))}};
  const std::string id = live.caller.send("POST", "/v1/renders", {}, render.dump()).value()["id"];
  json sweep{{"base", render}};
  sweep["base"]["scene"]["object"]["upload"] = name_of(tetrahedron_of(2));
  EXPECT_EQ(live.caller.send("POST", "/v1/sweeps", {}, sweep.dump()).status, 202);
  for (const int number : {1, 2}) age(tetrahedron_of(number), 4);
  EXPECT_EQ(put(tetrahedron_of(3)).status, 507);
  EXPECT_EQ(kept(), 2u);
  live.caller.send("POST", "/v1/renders/" + id + "/cancel");
  EXPECT_EQ(put(tetrahedron_of(3)).status, 201);
  EXPECT_FALSE(fs::exists(file(tetrahedron_of(1))));
}

TEST_F(FewUploads, ThatWereUsedAreNotOld) {
  for (const int number : {1, 2}) put(tetrahedron_of(number));
  for (const int number : {1, 2}) age(tetrahedron_of(number), 4);
  json render = json::parse(small_request(4));
  render["scene"]["object"] = {{"type", "mesh"}, {"upload", name_of(tetrahedron_of(1))}};
  const std::string id = live.caller.send("POST", "/v1/renders", {}, render.dump()).value()["id"];
  live.caller.send("POST", "/v1/renders/" + id + "/cancel");
  put(tetrahedron_of(2));
  EXPECT_EQ(put(tetrahedron_of(3)).status, 507);
}

TEST(UploadStoreTest, OfARestartHasWhatWasKeptAndNothingElse) {
  const TempFolder folder;
  const std::string bytes = tetrahedron, name = name_of(bytes);
  const auto keep = [&](UploadStore& store) {
    ReceivedFile file(store.folder(), 1000);
    file.append(bytes.substr(0, 10));
    file.append(bytes.substr(10));
    EXPECT_EQ(hex(file.sha256()), name);
    return store.keep(file, api::UploadKind::mesh, name);
  };
  {
    UploadStore store(folder / "uploads", 1 << 20);
    EXPECT_TRUE(keep(store));
    write_file(folder / "uploads/.tmp-0123456789abcdef", "half of a file");
    write_file(folder / "uploads/meshes/notes", "of an operator");
  }
  UploadStore store(folder / "uploads", 1 << 20);
  EXPECT_FALSE(keep(store));
  EXPECT_EQ(store.list(api::UploadKind::mesh).size(), 1u);
  EXPECT_EQ(store.find(api::UploadKind::mesh, name)->bytes, bytes.size());
  EXPECT_FALSE(fs::exists(folder / "uploads/.tmp-0123456789abcdef"));
  EXPECT_TRUE(fs::exists(folder / "uploads/meshes/notes"));
  EXPECT_FALSE(store.find(api::UploadKind::environment, name));
}

TEST(UploadStoreTest, CountsWhatIsToCome) {
  const TempFolder folder;
  UploadStore store(folder / "uploads", 1 << 20);
  auto room = store.reserve(600'000);
  EXPECT_TRUE(room);
  EXPECT_FALSE(store.reserve(600'000));
  room.reset();
  EXPECT_TRUE(store.reserve(600'000));
}

}  // namespace
}  // namespace translucube::server::test
