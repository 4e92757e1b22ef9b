// The OpenAPI document is what the service does: every operation is called, and every status that
// it lists is provoked and its answer held against its schema.

#include "picture/image_format.h"
#include "tests/server/calls/contract_service.h"
#include "tests/server/http/sockets.h"
#include "tests/server/tiny_uploads.h"

namespace translucube::server::test {
namespace {

const std::string small_sweep =
    R"({"base":)" + small_request(4) + R"(,"axes":{"absorption":[0,0.5],"roughness":[0.2,0.4]}})";

/// One that is larger than the service takes.
std::string large_body() { return std::string((1 << 20) + 1, ' '); }

/// Refusals that come before the operation is looked at.
void provoke_at_the_door(Contract& contract) {
  const Served guarded([](const HttpRequest&) { return HttpResponse{}; },
                       {true, {{"ci", sha256("secret")}}, {}, {}});
  const Served failing(
      [](const HttpRequest&) -> HttpResponse { throw std::runtime_error("a secret of ours"); });
  HttpOptions narrow;
  narrow.connections = 1;
  Sockets crowded(narrow);
  Wire only(crowded.server.port());
  ASSERT_TRUE(only.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n"));
  ASSERT_TRUE(eventually([&] { return crowded.stream.alive == 1; }));

  Caller at_guarded(contract, guarded.port()), at_failing(contract, failing.port()),
      at_crowded(contract, crowded.server.port());
  for (const Operation& operation : contract.operations()) {
    const bool open = operation.description.contains("security");
    if (!open) {
      at_guarded.call(operation.id, 401);
      at_guarded.call(operation.id, 401, no_such_id, "", {{"Authorization", "Bearer other"}});
    }
    const bool probe = operation.id == "live" || operation.id == "ready";
    if (!probe) {
      at_guarded.call(operation.id, 421, no_such_id, "", {{"Host", "evil.example"}});
      if (operation.changes_something())
        at_guarded.call(operation.id, 403, no_such_id, "", {{"Origin", "http://evil.example"}});
    }
    if (operation.id != "metrics") {  // answered before the calls
      const Answer failure =
          at_failing.call(operation.id, 500, no_such_id, "", {}, operation.body());
      EXPECT_EQ(failure.body.find("secret"), failure.body.npos);
    }
    at_crowded.call(operation.id, 503);
  }
}

/// What all operations have in common.
void provoke_everywhere(Contract& contract) {
  Live idle(contract, 0);
  for (const Operation& operation : contract.operations()) {
    if (operation.has(422))
      idle.caller.call(operation.id, 422, no_such_id, "?no_such=1", {}, operation.body());
    const bool needs_one = operation.pattern.find("{id}") != operation.pattern.npos;
    if (needs_one) idle.caller.call(operation.id, 404);
    if (operation.method == "GET" && !needs_one) {
      const Answer answer = idle.caller.call(operation.id, 200);
      const Answer head = idle.caller.send("HEAD", path_of(operation.pattern, ""));
      EXPECT_EQ(head.status, 200);
      EXPECT_EQ(head.header("ETag"), answer.header("ETag"));
      if (operation.has(304))
        idle.caller.call(operation.id, 304, "", "", {{"If-None-Match", answer.header("ETag")}});
    }
  }
  const Answer none = idle.caller.send("GET", "/web/../service.json");
  EXPECT_EQ(none.status, 404);
  idle.caller.call("explorerFile", 404, "", "x");
  idle.service.service.shut_down();
  for (const char* id : {"createRender", "createSweep"})
    idle.caller.call(id, 503, "", "", {},
                     std::string_view(id) == "createRender" ? small_request(4) : small_sweep);
  idle.caller.call("ready", 503);
}

/// What a broken disk leaves of the service. The index of the write-ahead log must keep its size:
/// the store has it mapped.
void provoke_without_store(Contract& contract) {
  Live broken(contract, 0);
  const std::filesystem::path store = broken.service.data.store_file();
  std::filesystem::resize_file(store, 0);
  std::filesystem::resize_file(store.string() + "-wal", 0);
  const std::string index = store.string() + "-shm";
  std::fstream(index, std::ios::binary | std::ios::in | std::ios::out)
      << std::string(std::filesystem::file_size(index), '\0');
  std::filesystem::remove_all(broken.service.data.uploads());
  for (const Operation& operation : contract.operations())
    if (operation.has(507)) {
      const Answer answer =
          broken.caller.call(operation.id, 507, no_such_id, "", {}, operation.body());
      EXPECT_EQ(answer.body.find(broken.folder.path().string()), answer.body.npos);
    }
}

struct Submission {
  std::string create, get, list, cancel, remove, body, other;
};

/// What renders and sweeps have in common.
void provoke_submission(Contract& contract, const Submission& kind) {
  Live idle(contract, 0), busy(contract, 1);
  const auto post = [&](int status, const std::string& body, const httplib::Headers& headers = {}) {
    return idle.caller.call(kind.create, status, "", "", headers, body);
  };
  const std::string id = post(202, kind.body, {{"Idempotency-Key", "k"}}).value()["id"];
  const Answer again = post(202, kind.body, {{"Idempotency-Key", "k"}});
  EXPECT_EQ(again.header("Idempotency-Replayed"), "true");
  EXPECT_EQ(post(422, kind.other, {{"Idempotency-Key", "k"}}).value()["type"],
            api::kind(api::ProblemCode::idempotency_mismatch).type);
  post(400, "{");
  post(413, large_body());
  post(415, kind.body, {{"Content-Type", "text/plain"}});
  post(422, R"({"sead":1})");
  EXPECT_EQ(idle.caller.call(kind.list, 200, "", "?status=queued&limit=1").value().size(), 2u);

  const Answer first = idle.caller.call(kind.get, 200, id, "?wait=0");
  idle.caller.call(kind.get, 304, id, "", {{"If-None-Match", first.header("ETag")}});
  EXPECT_EQ(idle.caller.call(kind.cancel, 200, id).value()["state"], "canceled");
  post(200, kind.body, {{"Idempotency-Key", "k"}});  // it has ended
  idle.caller.call(kind.remove, 204, id);

  const std::string other = busy.caller.call(kind.create, 202, "", "", {}, kind.body).value()["id"];
  const json ended = busy.caller.call(kind.get, 200, other, "?wait=60").value();
  EXPECT_EQ(ended["state"], "succeeded");
  const json list = busy.caller.call(kind.list, 200).value();
  EXPECT_EQ(list[kind.list == "listRenders" ? "renders" : "sweeps"].size(), 1u);
}

void provoke_images(Contract& contract) {
  Live busy(contract, 1), idle(contract, 0);
  const std::string render =
      busy.caller.call("createRender", 200, "", "", {{"Prefer", "wait=60"}}, small_request(4))
          .value()["id"];
  const std::string again =
      busy.caller.call("createRender", 200, "", "", {}, small_request(4)).value()["id"];
  EXPECT_EQ(busy.caller.call("getRender", 200, again).value()["cached"], true);
  const std::string sweep =
      busy.caller.call("createSweep", 202, "", "", {}, small_sweep).value()["id"];
  busy.caller.call("getSweep", 200, sweep, "?wait=60");

  for (const auto& [operation, id] : {std::pair<std::string, std::string>{"getImage", render},
                                      {"getPointImage", sweep},
                                      {"getSheet", sweep}}) {
    std::string etag;
    for (const ImageFormatRow& format : image_formats)
      etag = busy.caller.call(operation, 200, id, "?format=" + std::string(format.name))
                 .header("ETag");
    busy.caller.call(operation, 304, id, "?format=jpeg", {{"If-None-Match", etag}});
    const Answer part = busy.caller.call(operation, 206, id, "", {{"Range", "bytes=0-3"}});
    EXPECT_EQ(part.body, "\x89PNG");
    busy.caller.call(operation, 416, id, "", {{"Range", "bytes=99999999-"}});
    busy.caller.call(operation, 406, id, "", {{"Accept", "text/html"}});
    busy.caller.call(operation, 422, id, "?display=none");
  }
  busy.caller.call("getImage", 409, render, "?absorption=0.5");
  busy.caller.call("getPointImage", 409, sweep, "?absorber=amber");

  // Removed to make room.
  for (const StoredResult& result : busy.service.store.least_recently_used(1 << 30)) {
    EXPECT_TRUE(busy.service.store.remove_result(result));
    remove_files(busy.service.artifacts, result);
  }
  busy.caller.call("getImage", 410, render);
  busy.caller.call("getPointImage", 410, sweep);

  const std::string queued =
      idle.caller.call("createRender", 202, "", "", {}, small_request(4)).value()["id"];
  idle.caller.call("getImage", 409, queued);
  json many = json::parse(small_sweep);
  many["axes"] = {{"absorption", {{"from", 0}, {"to", 1}, {"count", 5000}}}};
  const std::string long_sweep =
      idle.caller.call("createSweep", 202, "", "", {}, many.dump()).value()["id"];
  idle.caller.call("getPointImage", 409, long_sweep);
  idle.caller.call("getSheet", 409, long_sweep);
}

void provoke_sweeps_own(Contract& contract) {
  StoreOptions short_queue;
  short_queue.most_queued = 2;
  Live full(contract, 0, short_queue);
  const json counts =
      full.caller.call("createSweep", 200, "", "?dry_run=true", {}, small_sweep).value();
  EXPECT_EQ(counts,
            (json{{"points", 4}, {"traced_images", 2}, {"pixels", 64}, {"camera_samples", 512.0}}));
  full.caller.call("createSweep", 422, "", "?dry_run=perhaps", {}, small_sweep);
  const std::string sweep =
      full.caller.call("createSweep", 202, "", "", {}, small_sweep).value()["id"];
  full.caller.call("createSweep", 429, "", "", {}, small_sweep);
  full.caller.call("createRender", 429, "", "", {}, small_request(4));
  full.caller.call("getSheet", 200, sweep);  // of empty frames
}

void provoke_events(Contract& contract) {
  Live busy(contract, 1);
  for (const auto& [create, events, body] :
       {std::array<std::string, 3>{"createRender", "getRenderEvents", small_request(64, 5)},
        {"createSweep", "getSweepEvents", small_sweep}}) {
    busy.renderer.milliseconds_per_pass = 20;
    const std::string id = busy.caller.call(create, 202, "", "", {}, body).value()["id"];
    const std::string stream = busy.caller.call(events, 200, id).body;
    EXPECT_THAT(stream, testing::StartsWith("retry: 2000\n\nid: 1\nevent: state\n"));
    EXPECT_THAT(stream, testing::HasSubstr(R"("state":"succeeded")"));
    busy.caller.call(events, 200, id, "", {{"Last-Event-ID", "1"}});
    busy.caller.call(events, 204, id, "", {{"Last-Event-ID", "1000000"}});
    const auto crowd = take_all_but(0, busy.context.streams);
    busy.caller.call(events, 503, id);
  }
}

void provoke_uploads(Contract& contract) {
  Live idle(contract, 0);
  for (const auto& [put, bytes] : {std::pair<std::string, std::string>{"putMesh", tetrahedron},
                                   {"putEnvironment", tiny_map}}) {
    const std::string name = hex(sha256(bytes));
    idle.caller.call(put, 201, name, "", {}, bytes);
    idle.caller.call(put, 200, name, "", {}, bytes);
    idle.caller.call(put, 422, name, "", {}, bytes + "more");
    idle.caller.call(put, 413, name, "", {}, large_body());
    idle.caller.call(put, 415, name, "", {{"Content-Encoding", "gzip"}}, bytes);
  }
  const json there = idle.caller.call("listMeshes", 200).value();
  EXPECT_EQ(there["meshes"].size(), 1u);
  EXPECT_EQ(idle.caller.call("listEnvironments", 200).value()["uploads"].size(), 1u);
}

TEST(ContractTest, EveryAnswerIsDescribedAndEveryDescriptionIsTrue) {
  Contract contract;
  provoke_at_the_door(contract);
  provoke_everywhere(contract);
  provoke_without_store(contract);
  provoke_submission(contract, {"createRender", "getRender", "listRenders", "cancelRender",
                                "deleteRender", small_request(4), small_request(8)});
  provoke_submission(
      contract, {"createSweep", "getSweep", "listSweeps", "cancelSweep", "deleteSweep", small_sweep,
                 R"({"base":)" + small_request(8) + "}"});
  provoke_images(contract);
  provoke_uploads(contract);
  provoke_sweeps_own(contract);
  provoke_events(contract);

  std::set<std::string> described;
  for (const Operation& operation : contract.operations())
    for (const auto& [status, response] : operation.description["responses"].items())
      described.insert(operation.id + ' ' + status);
  EXPECT_EQ(contract.provoked, described);
}

TEST(ContractTest, OtherMethodsAreRefusedWithThoseThatThereAre) {
  Contract contract;
  Live idle(contract, 0);
  std::map<std::string, std::set<std::string>> described;
  for (const Operation& operation : contract.operations())
    described[operation.pattern].insert(operation.method);
  for (const auto& [pattern, methods] : described)
    for (const std::string method : {"GET", "POST", "PUT", "PATCH", "DELETE"}) {
      if (methods.contains(method)) continue;
      const Answer answer = idle.caller.send(method, path_of(pattern, no_such_id));
      EXPECT_EQ(answer.status, 405) << method << ' ' << pattern;
      contract.check_problem(answer);
      for (const std::string& allowed : methods)
        EXPECT_THAT(answer.header("Allow"), HasSubstr(allowed)) << pattern;
    }
}

TEST(ContractTest, EveryExampleOfARequestIsAccepted) {
  Contract contract;
  Live idle(contract, 0);
  int posted = 0;
  for (const Operation& operation : contract.operations()) {
    if (!operation.description.contains("requestBody")) continue;
    const json& contents = operation.description["requestBody"]["content"];
    if (!contents.contains("application/json")) continue;  // a file
    const json& content = contents["application/json"];
    for (const auto& [name, example] : content["examples"].items()) {
      SCOPED_TRACE(name);
      contract.expect_fits(content["schema"], example["value"]);
      idle.caller.call(operation.id, 202, "", "", {}, example["value"].dump());
      ++posted;
    }
  }
  EXPECT_GE(posted, 9);
}

TEST(ContractTest, WhatIsNoRequestIsAnsweredAsSaid) {
  const Contract contract;
  HttpOptions impatient;
  impatient.header_timeout = milliseconds(200);
  const Sockets sockets(impatient);
  const std::string head = "GET / HTTP/1.1\r\nHost: localhost\r\n";
  std::string many_headers = head;
  for (int i = 0; i < 10; ++i) many_headers += "X: " + std::string(7 << 10, 'x') + "\r\n";
  const std::vector<std::pair<int, std::string>> messages{
      {400, "nonsense\r\n\r\n"},
      {431, head + "X: " + std::string(9 << 10, 'x') + "\r\n\r\n"},
      {417, head + "Expect: miracles\r\n\r\n"},
      {501, "BREW / HTTP/1.1\r\nHost: localhost\r\n\r\n"},
      {505, "GET / HTTP/2.0\r\nHost: localhost\r\n\r\n"},
      {408, head},
      {413, "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 999999999999\r\n\r\n"},
      {414, "GET /" + std::string(9 << 10, 'x') + " HTTP/1.1\r\nHost: localhost\r\n\r\n"},
      {431, many_headers}};
  for (const auto& [status, message] : messages) {
    Wire wire(sockets.server.port());
    wire.send(message);
    const std::string text = wire.receive();
    EXPECT_THAT(text, StartsWith("HTTP/1.1 " + std::to_string(status)));
    const auto end = text.find("\r\n\r\n");
    ASSERT_NE(end, text.npos) << status;
    contract.check_problem(
        {status, {{"Content-Type", "application/problem+json"}}, text.substr(end + 4)});
  }
}

}  // namespace
}  // namespace translucube::server::test
