// A run as robomimic's HDF5 and as RLDS, read by h5py and by Python's standard library.
#include <cstdio>

#include "runtime/base/json.h"
#include "runtime/export/dataset/tfrecord.h"
#include "tests/runtime/export/dataset/exported_run.h"

namespace probe::dataset {
namespace {

Json read_by(const std::string& program, const std::string& path) {
  const std::string command = "/usr/bin/python3 '" VLAPROBE_SOURCE_DIR
                              "/tests/runtime/export/dataset/" +
                              program + "' '" + path + "' 2>&1";
  std::string words;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    words.append(buffer, n);
  const int status = pclose(pipe);
  REQUIRE_MESSAGE(status == 0, words);
  return Json::parse(words);
}

bool has_h5py() {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") == 0) return true;
  MESSAGE("SKIPPED: python3-h5py is not installed, so nobody else read the robomimic file");
  return false;
}

double single(double value) { return static_cast<double>(static_cast<float>(value)); }

TEST_CASE("a robomimic file has every frame and picture of its run, as h5py sees it") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  must_export(folder / "run", folder / "set", Format::kRobomimic, dataset_options());
  if (!has_h5py()) return;
  const Json read = read_by("read_robomimic.py", folder / "set/demos.hdf5");
  const auto traces = traces_of(folder / "run");
  CHECK(read["total"] == kEpisodes * kHorizon);
  CHECK(read["env_args"].contains("env_kwargs"));
  CHECK(read["mask"]["train"] == Json::array({"demo_0", "demo_1", "demo_2", "demo_3"}));
  CHECK(read["mask"]["failure"].size() == kEpisodes);  // nobody succeeds at random
  REQUIRE(read["demos"].size() == kEpisodes);
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const Json& demo = read["demos"][i];
    const store::Trace& trace = traces[i].trace;
    CHECK(demo["num_samples"] == kHorizon);
    CHECK(demo["ep_meta"]["lang"] == trace.header.prompt);
    REQUIRE(demo["actions"].size() == kHorizon);
    for (std::size_t k = 0; k < kHorizon; ++k) {
      CHECK(demo["actions"][k] == Json(trace.steps[k].action));
      const auto& q = k == 0 ? trace.start->q : trace.steps[k - 1].q;
      CHECK(demo["joints"][k] == Json(q));
      // A single camera's hash is that of its bytes.
      CHECK(demo["pictures"]["third_view"][k] == to_hex(trace.steps[k].image_hash));
      CHECK(demo["dones"][k] == (k + 1 == kHorizon ? 1 : 0));
    }
  }
}

TEST_CASE(
    "RLDS records have every frame and picture of their run, as the standard library sees them") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  DatasetOptions options = dataset_options();
  options.most_data = 200'000;
  must_export(folder / "run", folder / "set", Format::kRlds, options);
  const Json read = read_by("read_rlds.py", folder / "set/1.0.0");
  const auto traces = traces_of(folder / "run");
  CHECK(read["info"]["splits"][0]["shardLengths"].size() > 1);
  REQUIRE(read["episodes"].size() == kEpisodes);
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const Json& episode = read["episodes"][i];
    const store::Trace& trace = traces[i].trace;
    CHECK(episode["episode_metadata/episode_id"] == Json::array({i}));
    CHECK(episode["steps/is_first"] == Json::array({1, 0, 0, 0, 0, 0, 0}));
    CHECK(episode["steps/is_last"] == Json::array({0, 0, 0, 0, 0, 0, 1}));
    CHECK(episode["steps/is_terminal"] == Json::array({0, 0, 0, 0, 0, 0, 0}));
    CHECK(episode["steps/language_instruction"][3] == trace.header.prompt);
    for (std::size_t k = 0; k < kHorizon; ++k) {
      const auto& action = trace.steps[k].action;
      CHECK(episode["steps/observation/image_0"][k] == to_hex(trace.steps[k].image_hash));
      for (std::size_t c = 0; c < 3; ++c)
        CHECK(episode["steps/action"][7 * k + c].get<double>() == single(action[c]));
      CHECK(episode["steps/action"][7 * k + 6].get<double>() == single((action[6] + 1) / 2));
    }
  }
}

TEST_CASE("both formats are the same bytes whatever the threads, also with several wordings") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  const std::string prompt = traces_of(folder / "run")[0].trace.header.prompt;
  std::ofstream(folder / "w.jsonl")
      << R"({"task":"carrot_on_plate","original":")" << prompt
      << R"(","wording":"lay it down","split":"train","probability":0.5,"original_probability":0.5})"
      << "\n";
  DatasetOptions options = dataset_options();
  options.rephrase = folder / "w.jsonl";
  options.wordings = 2;
  for (const Format format : {Format::kRobomimic, Format::kRlds}) {
    const std::string name = folder / std::to_string(static_cast<int>(format));
    options.jobs = 1;
    CHECK(must_export(folder / "run", name + "a", format, options).episodes == 2 * kEpisodes);
    options.jobs = 3;
    must_export(folder / "run", name + "b", format, options);
    CHECK(all_files(name + "a") == all_files(name + "b"));
  }
  if (!has_h5py()) return;
  const Json read =
      read_by("read_robomimic.py",
              (folder / std::to_string(static_cast<int>(Format::kRobomimic))) + "a/demos.hdf5");
  REQUIRE(read["demos"].size() == 2 * kEpisodes);
  CHECK(read["demos"][0]["pictures"] == read["demos"][1]["pictures"]);
  CHECK(read["demos"][0]["ep_meta"]["lang"] != read["demos"][1]["ep_meta"]["lang"]);
}

std::string hex(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x",
                  static_cast<unsigned>(static_cast<unsigned char>(c)));
    text += digits;
  }
  return text;
}

TEST_CASE("records and their messages are the published bytes") {
  CHECK(crc32c("123456789") == 0xe3069283);
  CHECK(masked_crc32c("123456789") == 0xc78ab0e5);
  const run::TemporaryFolder folder;
  auto file = RecordFile::create(folder / "r");
  REQUIRE(file.ok());
  REQUIRE((*file)->add("").ok());
  REQUIRE((*file)->add("a").ok());
  REQUIRE((*file)->add("hello").ok());
  REQUIRE((*file)->finish().ok());
  CHECK(hex(text_of(folder / "r")) ==
        "000000000000000029039807d8ea82a2"
        "01000000000000000175de4161786ee428"
        "0500000000000000eab2043e68656c6c6fbb1f1c19");
  ExampleMessage reals, bytes, wholes;
  reals.reals("a", std::vector<float>{0.5f, -1.0f});
  bytes.bytes("a", std::vector<std::string>{"hi"});
  wholes.wholes("steps/is_first", std::vector<std::int64_t>{1, 0});
  CHECK(hex(reals.finish()) == "0a130a110a0161120c120a0a080000003f000080bf");
  CHECK(hex(bytes.finish()) == "0a0d0a0b0a016112060a040a026869");
  CHECK(hex(wholes.finish()) == "0a1a0a180a0e73746570732f69735f666972737412061a040a020100");
}

}  // namespace
}  // namespace probe::dataset
