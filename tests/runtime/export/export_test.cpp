// What is exported is what was recorded, read back with the other tools' own libraries.
#include "runtime/export/export.h"
#include "runtime/base/json.h"

#include <doctest/doctest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/store/sample_trace.h"

namespace probe::exporting {
namespace {

using run::TemporaryFolder;

struct Recorded {
  store::ResultRow row;
  store::Trace trace;
};

Recorded recorded(const TemporaryFolder& folder) {
  const auto hash = store::write_sample_trace(folder / "a.trace", 4);
  REQUIRE(hash.ok());
  auto trace = store::read_trace(folder / "a.trace");
  REQUIRE(trace.ok());
  Recorded out{{}, std::move(*trace)};
  out.row.task = out.trace.header.task;
  out.row.metrics = out.trace.end->metrics;
  out.row.trace_sha256 = to_hex(out.trace.hash);
  out.row.idle = 10;
  out.row.delay = 2;
  out.row.joints = {{"cabinet.top", 0.125}};
  return out;
}

std::vector<double> read_reals(hid_t file, const std::string& name, std::vector<hsize_t>& shape) {
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  REQUIRE_MESSAGE(set >= 0, name);
  const hid_t space = H5Dget_space(set);
  shape.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (!values.empty())
    CHECK(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  H5Sclose(space);
  H5Dclose(set);
  return values;
}

std::string read_text(hid_t file, const std::string& group, const char* name) {
  const hid_t attribute = H5Aopen_by_name(file, group.c_str(), name, H5P_DEFAULT, H5P_DEFAULT);
  REQUIRE_MESSAGE(attribute >= 0, name);
  const hid_t type = H5Aget_type(attribute);
  char* text = nullptr;
  CHECK(H5Aread(attribute, type, &text) >= 0);
  std::string value = text == nullptr ? "" : text;
  H5free_memory(text);
  H5Tclose(type);
  H5Aclose(attribute);
  return value;
}

double read_number(hid_t file, const std::string& group, const char* name) {
  const hid_t attribute = H5Aopen_by_name(file, group.c_str(), name, H5P_DEFAULT, H5P_DEFAULT);
  REQUIRE_MESSAGE(attribute >= 0, name);
  double value = 0;
  CHECK(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0);
  H5Aclose(attribute);
  return value;
}

TEST_CASE("an HDF5 file has a group an episode with every number of its trace") {
  const TemporaryFolder folder;
  const Recorded in = recorded(folder);
  auto sink = open_hdf5(folder / "x.h5");
  REQUIRE(sink.ok());
  REQUIRE((*sink)->episode(in.row, in.trace).ok());
  REQUIRE((*sink)->finish().ok());

  const hid_t file = H5Fopen((folder / "x.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(file >= 0);
  const std::string group = "/carrot_on_plate/3-42";
  CHECK(read_text(file, group, "prompt") == "put carrot on plate");
  CHECK(read_text(file, group, "start_id") == to_hex(in.trace.header.start_id));
  CHECK(read_text(file, group, "invalid").empty());
  CHECK(read_text(file, group, "live").empty());
  CHECK(read_number(file, group, "idle") == 10);
  CHECK(read_number(file, group, "delay") == 2);
  std::vector<hsize_t> shape;
  const auto action = read_reals(file, group + "/action", shape);
  CHECK(shape == std::vector<hsize_t>{4, 7});
  for (std::size_t i = 0; i < action.size(); ++i)
    CHECK(action[i] == in.trace.steps[i / 7].action[i % 7]);
  const auto position = read_reals(file, group + "/body_position", shape);
  CHECK(shape == std::vector<hsize_t>{4, 2, 3});
  CHECK(position[3 * 2 * 3] == in.trace.steps[3].sample.bodies[0].position.x());
  const auto rotation = read_reals(file, group + "/body_rotation", shape);
  CHECK(rotation[0] == in.trace.steps[0].sample.bodies[0].rotation.w());
  const auto metrics = read_reals(file, group + "/metrics", shape);
  CHECK(metrics[2 * 3] == 1.0);
  CHECK(metrics[2 * 3 + 1] == 0.5);
  const auto push = read_reals(file, group + "/contact_push", shape);
  CHECK(shape == std::vector<hsize_t>{4, 3});
  CHECK(push[3 * 1 + 2] == -2e-3);
  const auto image = read_reals(file, group + "/image_sha256", shape);
  CHECK(image[32 + 5] == in.trace.steps[1].image_hash.bytes[5]);
  const auto half = read_reals(file, group + "/start_half", shape);
  CHECK(half[3] == 0.05);
  H5Fclose(file);
}

TEST_CASE("JSON lines have an episode line and a line a step with exact numbers") {
  const TemporaryFolder folder;
  const Recorded in = recorded(folder);
  auto sink = open_json_lines(folder / "x.jsonl");
  REQUIRE(sink.ok());
  REQUIRE((*sink)->episode(in.row, in.trace).ok());
  REQUIRE((*sink)->finish().ok());
  std::ifstream file(folder / "x.jsonl");
  std::vector<Json> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(Json::parse(line));
  REQUIRE(lines.size() == 5);
  CHECK(lines[0]["kind"] == "episode");
  CHECK(lines[0]["metrics"]["success"] == true);
  CHECK(lines[0]["start"]["q"][0] == 0.5);
  CHECK(lines[0]["idle"] == 10);
  CHECK(lines[0]["delay"] == 2);
  CHECK(lines[0]["fixture_joints"]["cabinet.top"] == 0.125);
  CHECK(lines[2]["kind"] == "step");
  CHECK(lines[2]["step"] == 2.0);
  CHECK(lines[0]["live"].is_null());  // its world waited
  CHECK(lines[2]["live"].is_null());
  CHECK(lines[2]["tcp_m"][2] == 1.0 / 3);
  CHECK(lines[2]["bodies"]["carrot"]["position_m"][0] ==
        in.trace.steps[1].sample.bodies[0].position.x());
  CHECK(lines[2]["contacts"][0]["b"] == "plate");
  CHECK(lines[2]["image_sha256"] == to_hex(in.trace.steps[1].image_hash));
  CHECK(lines[2]["metrics"]["success"] == false);
}

// The sample's world did not wait: asked before its first step, answered in its third.
Recorded recorded_live(const TemporaryFolder& folder) {
  Recorded out = recorded(folder);
  out.trace.header.live = policy::LiveTerms{0.4, 0.5};
  for (store::TraceStep& step : out.trace.steps) step.live.emplace();
  out.trace.steps[0].live->asks = true;
  out.trace.steps[2].live = {policy::LiveSource::kAnswer, true, {{0, 0.4}}};
  out.trace.steps[3].live->source = policy::LiveSource::kLate;
  return out;
}

TEST_CASE("a live episode has where its actions are from and how late its answers were") {
  const TemporaryFolder folder;
  const Recorded in = recorded_live(folder);
  auto sink = open_hdf5(folder / "x.h5");
  REQUIRE(sink.ok());
  REQUIRE((*sink)->episode(in.row, in.trace).ok());
  REQUIRE((*sink)->finish().ok());
  const hid_t file = H5Fopen((folder / "x.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(file >= 0);
  const std::string group = "/carrot_on_plate/3-42";
  CHECK(read_text(file, group, "live") == "live, 400 ms, at most 50 % held");
  std::vector<hsize_t> shape;
  CHECK(read_reals(file, group + "/live_source", shape) == std::vector<double>{2, 2, 0, 1});
  CHECK(read_reals(file, group + "/live_asks", shape) == std::vector<double>{1, 0, 1, 0});
  CHECK(read_reals(file, group + "/answer_step", shape) ==
        std::vector<double>{in.trace.steps[2].sample.step});
  CHECK(read_reals(file, group + "/answer_asked", shape) == std::vector<double>{0});
  CHECK(read_reals(file, group + "/answer_delay_steps", shape) == std::vector<double>{2});
  CHECK(read_reals(file, group + "/answer_delay_s", shape) == std::vector<double>{0.4});
  H5Fclose(file);

  auto lines_sink = open_json_lines(folder / "x.jsonl");
  REQUIRE(lines_sink.ok());
  REQUIRE((*lines_sink)->episode(in.row, in.trace).ok());
  REQUIRE((*lines_sink)->finish().ok());
  std::ifstream text(folder / "x.jsonl");
  std::vector<Json> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(Json::parse(line));
  REQUIRE(lines.size() == 5);
  CHECK(lines[0]["live"] == Json{{"delay_s", 0.4}, {"most_held", 0.5}});
  CHECK(lines[1]["live"] == Json{{"source", "held"}, {"asks", true}, {"answers", Json::array()}});
  CHECK(lines[3]["live"]["source"] == "answer");
  CHECK(lines[3]["live"]["answers"] ==
        Json::array({{{"asked", 0}, {"delay_steps", 2}, {"delay_s", 0.4}}}));
  CHECK(lines[4]["live"]["source"] == "late");
}

TEST_CASE("what cannot be written is told") {
  const TemporaryFolder folder;
  CHECK(open_hdf5(folder / "no/such/x.h5").failure().code == Fault::kIo);
  CHECK(open_json_lines(folder / "no/such/x.jsonl").failure().code == Fault::kIo);
  CHECK(export_run(folder / "absent", folder / "x.h5").failure().code == Fault::kStore);
  CHECK(export_run(folder / "absent", folder / "x.csv").failure().code == Fault::kUsage);
  Recorded in = recorded(folder);
  in.trace.steps[1].q.pop_back();  // a forged trace whose steps do not have what its header names
  auto sink = open_hdf5(folder / "y.h5");
  REQUIRE(sink.ok());
  CHECK(!(*sink)->episode(in.row, in.trace).ok());
}

// What a process of its own does with room for files of so many bytes, until its very end: 0 where
// all of it was written, 1 where it was told that it was not.
int exit_with_room(rlim_t room, const Recorded& in, const std::string& path) {
  std::fflush(nullptr);  // or the child writes it as well
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);  // the write fails instead
    rlimit limit{room, RLIM_INFINITY};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) std::_Exit(7);
    const auto written = [&]() -> Status {
      PROBE_ASSIGN(auto sink, open_hdf5(path));
      for (int episode = 0; episode < 40; ++episode) {
        store::Trace trace = in.trace;
        trace.header.episode = episode;
        PROBE_TRY(sink->episode(in.row, trace));
      }
      return sink->finish();
    }();
    if (!written.ok() && to_text(written.failure()).find("File too large") == std::string::npos)
      std::exit(5);
    std::exit(written.ok() ? 0 : 1);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

TEST_CASE("a full disk is told, wherever in the file it happens, and ends nobody's program") {
  const TemporaryFolder folder;
  const Recorded in = recorded(folder);
  const std::string path = folder / "x.h5";
  REQUIRE(exit_with_room(RLIM_INFINITY, in, path) == 0);
  const auto whole = static_cast<rlim_t>(std::filesystem::file_size(path));
  CHECK(exit_with_room(whole, in, path) == 0);
  for (int part = 0; part < 20; ++part) {
    const rlim_t room = whole * static_cast<rlim_t>(part) / 20;
    CAPTURE(room);
    CHECK(exit_with_room(room, in, path) == 1);
  }
  CHECK(exit_with_room(whole - 1, in, path) == 1);
}

}  // namespace
}  // namespace probe::exporting
