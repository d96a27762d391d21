// A run as robomimic's HDF5 and as RLDS, read by h5py and by Python's standard library.
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <functional>

#include "runtime/base/json.h"
#include "runtime/export/dataset/check.h"
#include "runtime/export/dataset/tfrecord.h"
#include "runtime/export/dataset/tfrecord_read.h"
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
      CHECK(demo["actions"][k] ==
            Json(std::vector<double>(trace.steps[k].action.begin(), trace.steps[k].action.end())));
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

TEST_CASE("actions of joints are named by them, and come as they were said") {
  const run::TemporaryFolder folder;
  make_run(told_table(), folder / "run", "null");
  must_export(folder / "run", folder / "rlds", Format::kRlds, dataset_options());
  const auto traces = traces_of(folder / "run");
  REQUIRE(traces.size() == 2);
  REQUIRE(traces[0].trace.header.joint_actions.has_value());
  const Json read = read_by("read_rlds.py", folder / "rlds/1.0.0");
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const Json& actions = read["episodes"][i]["steps/action"];
    REQUIRE(actions.size() == 7 * kHorizon);
    for (std::size_t k = 0; k < kHorizon; ++k) {
      const auto& action = traces[i].trace.steps[k].action;
      for (std::size_t c = 0; c < 6; ++c)
        CHECK(actions[7 * k + c].get<double>() == single(action[c]));
      CHECK(actions[7 * k + 6].get<double>() == 1);  // -1 .. 1 as Bridge's 0 .. 1
    }
  }
  must_export(folder / "run", folder / "lerobot", Format::kLerobot, dataset_options());
  std::ifstream info(folder / "lerobot/meta/info.json");
  const Json features = Json::parse(std::string(std::istreambuf_iterator<char>(info), {}));
  CHECK(features["features"]["action"]["names"].dump() ==
        R"(["waist","shoulder","elbow","forearm_roll","wrist_angle","wrist_rotate","gripper"])");
  const auto checked = check_dataset(folder / "lerobot");
  REQUIRE_MESSAGE(checked.ok(), to_text(checked.failure()));
  for (const std::string& problem : checked->problems) CHECK_MESSAGE(problem.empty(), problem);
  std::ifstream about(folder / "lerobot/README.md");
  const std::string words(std::istreambuf_iterator<char>(about), {});
  CHECK(words.find("position of each arm joint, rad and m; gripper") != std::string::npos);
}

TEST_CASE("both formats are the same bytes whatever the threads, also with several wordings") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  write_wording(folder / "run", folder / "w.jsonl");
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

TEST_CASE("both formats tell of a disk that is full, and of a folder that is there") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  for (const Format format : {Format::kRobomimic, Format::kRlds}) {
    const std::string out = folder / std::to_string(static_cast<int>(format));
    for (const rlim_t room : {rlim_t{600}, rlim_t{9000}, rlim_t{40000}}) {
      CAPTURE(room);
      rlimit less = before;
      less.rlim_cur = room;
      REQUIRE(setrlimit(RLIMIT_FSIZE, &less) == 0);
      const auto done = export_dataset({folder / "run"}, out, format, dataset_options());
      REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
      REQUIRE(!done.ok());
      CHECK(done.failure().code == Fault::kIo);
      CHECK(done.failure().where.find(out + ".partial/") == 0);
      CHECK(!std::filesystem::exists(out));
      CHECK(!std::filesystem::exists(out + ".partial"));
    }
    std::filesystem::create_directories(out);
    std::ofstream(out + "/mine.txt") << "mine";
    CHECK(!export_dataset({folder / "run"}, out, format, dataset_options()).ok());
    CHECK(all_files(out).size() == 1);
  }
  std::signal(SIGXFSZ, old);
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

std::vector<std::string> problems_of(const std::string& dir,
                                     const std::vector<std::string>& runs = {}) {
  const auto checked = check_dataset(dir, {.runs = runs});
  return checked ? checked->problems : std::vector<std::string>{to_text(checked.failure())};
}

// One of the problems has these words.
void check_told(const std::string& dir, const std::string& words) {
  const auto problems = problems_of(dir);
  std::string all;
  for (const std::string& problem : problems) all += problem + "\n";
  CHECK_MESSAGE(all.find(words) != std::string::npos, words << "\namong:\n" << all);
}

TEST_CASE("both formats are read back and held against their traces, pictures among it") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  make_run(small_table(), folder / "expert", "expert");
  write_wording(folder / "run", folder / "w.jsonl");
  for (const Format format : {Format::kRobomimic, Format::kRlds}) {
    for (const bool is_small : {false, true}) {
      DatasetOptions options = dataset_options();
      options.rephrase = folder / "w.jsonl";
      options.wordings = 2;
      if (is_small) options.width = options.height = 32;
      const std::string out =
          folder / (std::to_string(static_cast<int>(format)) + (is_small ? "s" : ""));
      must_export(folder / "run", out, format, options);
      const auto checked = check_dataset(out);
      REQUIRE_MESSAGE(checked.ok(), (checked.ok() ? "" : to_text(checked.failure())));
      for (const std::string& problem : checked->problems) CHECK_MESSAGE(problem.empty(), problem);
      CHECK(checked->demonstrations == kEpisodes);
      CHECK(checked->episodes == 2 * kEpisodes);
      CHECK(checked->frames == 2 * kEpisodes * kHorizon);
      // Where the run is somewhere else now, and where another one is in its place.
      std::filesystem::rename(folder / "run", folder / "moved");
      CHECK(problems_of(out, {folder / "moved"}).empty());
      CHECK(!problems_of(out).empty());
      CHECK(!problems_of(out, {folder / "expert"}).empty());
      std::filesystem::rename(folder / "moved", folder / "run");
    }
  }
}

// The dataset's only record file again, each message as `change` leaves it.
void rewrite(const std::string& dir, const std::function<void(Example&, std::size_t)>& change) {
  const std::string path = dir + "/1.0.0/vlaprobe_demos-train.tfrecord-00000-of-00001";
  std::vector<Example> all;
  RecordReader reader(path);
  for (;;) {
    auto record = reader.next();
    REQUIRE_MESSAGE(record.ok(), (record.ok() ? "" : to_text(record.failure())));
    if (!*record) break;
    all.push_back(read_example(**record, path).value());
    change(all.back(), all.size() - 1);
  }
  auto file = RecordFile::create(path).value();
  for (const Example& example : all) {
    ExampleMessage message;
    for (const auto& [key, feature] : example) {
      const std::vector<float> reals(feature.reals.begin(), feature.reals.end());
      if (!feature.texts.empty()) message.bytes(key, feature.texts);
      if (!reals.empty()) message.reals(key, reals);
      if (!feature.wholes.empty()) message.wholes(key, feature.wholes);
    }
    REQUIRE(file->add(message.finish()).ok());
  }
  REQUIRE(file->finish().ok());
}

TEST_CASE("resized pictures are held against what the policy saw, drawn and resized again") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  DatasetOptions options = dataset_options();
  options.width = options.height = 32;
  must_export(folder / "run", folder / "set", Format::kRlds, options);
  rewrite(folder / "set", [&](Example& example, std::size_t i) {
    auto& files = example["steps/observation/image_0"].texts;
    if (i == 1) std::swap(files[1], files[5]);
  });
  check_told(folder / "set", "step 1: its pictures are not those that the policy saw");
  CheckOptions copies_only;
  copies_only.redraws = false;
  CHECK(check_dataset(folder / "set", copies_only)->problems.empty());
  CHECK(check_dataset(folder / "set", copies_only)->not_redrawn == kEpisodes * kHorizon);
  CHECK(check_dataset(folder / "set")->not_redrawn == 0);
}

TEST_CASE("an RLDS dataset that was changed does not pass its check") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  const std::string out = folder / "set", kept = folder / "kept";
  must_export(folder / "run", kept, Format::kRlds, dataset_options());
  const auto with = [&](const std::function<void(Example&)>& change, const std::string& words) {
    std::filesystem::remove_all(out);
    std::filesystem::copy(kept, out, std::filesystem::copy_options::recursive);
    rewrite(out, [&](Example& example, std::size_t i) {
      if (i == 1) change(example);
    });
    check_told(out, words);
  };
  with([](Example& e) { e["steps/action"].reals[0] += 0.001; }, "action is not the trace's");
  with([](Example& e) { e["steps/action"].reals[4] += 0.001; }, "the turn of action");
  with([](Example& e) { e["steps/action"].reals[6] = 0.5; }, "the gripper's action");
  with([](Example& e) { e["steps/observation/state"].reals[7] += 0.001; }, "step 1: state x is");
  with([](Example& e) { e["steps/observation/state"].reals[3] = 4; }, "roll is no angle");
  with([](Example& e) { e["steps/observation/joints"].reals[3] += 0.001; }, "joints are not");
  with([](Example& e) { e["steps/reward"].reals.back() = 1; }, "reward is not the verdict");
  with([](Example& e) { e["steps/is_first"].wholes[2] = 1; }, "is_first is not true");
  with([](Example& e) { e["steps/is_last"].wholes.back() = 0; }, "is_last is not true");
  with([](Example& e) { e["steps/is_terminal"].wholes.back() = 1; }, "is_terminal is not");
  with([](Example& e) { e["steps/language_instruction"].texts[3] = "?"; }, "is not its wording");
  // The same in every step is told once.
  with([](Example& e) { std::ranges::fill(e["steps/observation/joints"].reals, 0.5); },
       "(and 6 more like it)");
  CHECK(problems_of(out).size() == 1);
  with([](Example& e) { e["episode_metadata/episode_id"].wholes = {7}; }, "episode_id");
  with([](Example& e) { e["episode_metadata/success"].wholes = {1}; }, "success is not");
  with([](Example& e) { e["steps/reward"].reals.pop_back(); }, "steps/reward has 6 numbers");
  with([](Example& e) { e.erase("steps/discount"); }, "other keys than features.json");
  // A picture of another step is a picture, but not what the policy saw there.
  with(
      [](Example& e) {
        auto& files = e["steps/observation/image_0"].texts;
        std::swap(files[1], files[5]);
      },
      "step 1: its pictures are not those that the policy saw");
  with([](Example& e) { e["steps/observation/image_0"].texts[2] = "no PNG"; }, "step 2");
  // Bytes that change, go and come.
  const std::string shard = out + "/1.0.0/vlaprobe_demos-train.tfrecord-00000-of-00001";
  const auto with_bytes = [&](const std::function<void(std::string&)>& change,
                              const std::string& words) {
    std::filesystem::remove_all(out);
    std::filesystem::copy(kept, out, std::filesystem::copy_options::recursive);
    std::string bytes = text_of(shard);
    change(bytes);
    std::ofstream(shard, std::ios::binary | std::ios::trunc) << bytes;
    check_told(out, words);
  };
  with_bytes([](std::string& bytes) { bytes[3000] ^= 1; }, "content whose checksum");
  with_bytes([](std::string& bytes) { bytes[2] ^= 1; }, "length whose checksum");
  with_bytes([](std::string& bytes) { bytes.resize(bytes.size() - 9); }, "is cut off");
  with_bytes([](std::string& bytes) { bytes += bytes; }, "has records behind the last");
  with_bytes([](std::string& bytes) { bytes.clear(); }, "has 0 records, the split says 4");
  std::filesystem::remove(shard);
  check_told(out, "cannot be read");
  for (const char* const splits : {R"({"train": 4})", "4", "[]"}) {
    std::ofstream(shard.substr(0, shard.rfind('/')) + "/dataset_info.json")
        << R"({"name": "vlaprobe", "splits": )" << splits << "}";
    check_told(out, "is not what `vlaprobe export` writes");
  }
}

TEST_CASE("a robomimic file that makes HDF5 crash is a finding") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  const std::string out = folder / "set", path = out + "/demos.hdf5";
  must_export(folder / "run", out, Format::kRobomimic, dataset_options());
  std::string bytes = read_file(path).value();
  // The second text of a heap, whose size stands in the 8 bytes before it.
  const std::size_t first = bytes.find("{\"lang\""), second = bytes.find("{\"lang\"", first + 1);
  REQUIRE(second != std::string::npos);
  bytes[second - 4] = 1;  // 4 GiB more
  std::ofstream(path, std::ios::binary) << bytes;
  check_told(out, "demo_1 (");
  check_told(out, "makes its reader crash (SIGSEGV)");
}

TEST_CASE("a robomimic file that was changed does not pass its check") {
  if (!has_h5py()) return;
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  const std::string out = folder / "set", kept = folder / "kept";
  must_export(folder / "run", kept, Format::kRobomimic, dataset_options());
  const auto with = [&](const std::string& change, const std::string& words) {
    CAPTURE(change);
    std::filesystem::remove_all(out);
    std::filesystem::copy(kept, out, std::filesystem::copy_options::recursive);
    std::ofstream(folder / "change.py") << "import h5py, json, sys\nwith h5py.File(sys.argv[1], "
                                           "'r+') as f:\n    d = f['data/demo_1']\n    "
                                        << change << "\n";
    const std::string command =
        "/usr/bin/python3 '" + (folder / "change.py") + "' '" + out + "/demos.hdf5' 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    check_told(out, words);
  };
  with("d['actions'][2, 1] += 0.001", "step 2: actions is not the trace's");
  with("d['obs/joints'][0, 0] += 0.001", "obs/joints are not");
  with("d['states'][0, 0] += 0.001", "states are not");
  with("d['obs/state'][1, 2] += 0.001", "step 1: obs/state z is");
  with("d['rewards'][6] = 1", "rewards is not the verdict");
  with("d['dones'][6] = 0", "dones is not 1");
  with("d['obs/third_view'][4, 10, 10, 1] += 1", "step 4: its pictures are not those");
  with("d.attrs['num_samples'] = 3", "num_samples");
  with("d.attrs['ep_meta'] = json.dumps({**json.loads(d.attrs['ep_meta']), 'lang': '?'})",
       "lang of");
  with("d.attrs['ep_meta'] = json.dumps({**json.loads(d.attrs['ep_meta']), 'success': True})",
       "success of ep_meta");
  with("d.attrs['ep_meta'] = 7", "ep_meta cannot be read");
  with("del d['obs/third_view']", "obs/third_view cannot be read");
  with("del f['data/demo_3']", "is not there");
  with("f.copy('data/demo_0', 'data/demo_4')", "data has 5 demonstrations");
  with("f['data'].attrs['total'] = 3", "total is not");
  with("del f['mask/failure']", "mask/failure is not what failed");
  with("a = d['actions'][:3]; del d['actions']; d['actions'] = a", "actions has another shape");
  std::ofstream(out + "/demos.hdf5", std::ios::trunc) << "no HDF5";
  check_told(out, "is no HDF5 file");
  std::filesystem::remove(out + "/demos.hdf5");
  check_told(out, "is no dataset of a format that is checked");
}

}  // namespace
}  // namespace probe::dataset
