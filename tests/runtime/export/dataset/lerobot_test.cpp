// A run as a LeRobot dataset: what others read in it is what the traces have.
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <functional>
#include <set>

#include "runtime/base/json.h"
#include "runtime/export/dataset/check.h"
#include "runtime/export/dataset/repeater.h"
#include "runtime/show/clip.h"
#include "tests/runtime/export/dataset/exported_run.h"

namespace probe::dataset {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVideo = "videos/observation.images.third_view/chunk-000/file-000.mp4";

std::string output_of(const std::string& command, int* status = nullptr) {
  std::string words;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    words.append(buffer, n);
  const int code = pclose(pipe);
  if (status != nullptr) *status = WIFEXITED(code) ? WEXITSTATUS(code) : -1;
  return words;
}

// hyparquet and DuckDB, from npm's cache or its registry; empty where it can give neither.
std::string readers() {
  const std::string from = VLAPROBE_SOURCE_DIR "/tests/runtime/export/readers";
  const std::string to = VLAPROBE_BINARY_DIR "/dataset_readers";
  int status = 0;
  output_of("mkdir -p '" + to + "' && cp '" + from + "/'* '" + to + "' && cd '" + to +
                "' && { [ -d node_modules/hyparquet ] || timeout 120 npm install --no-package-lock "
                "--ignore-scripts --prefer-offline --no-audit --no-fund --loglevel=error >npm.log "
                "2>&1; }",
            &status);
  if (status == 0) return to;
  MESSAGE(
      "SKIPPED: npm gave no hyparquet and DuckDB, so what we wrote was read by our reader alone");
  return "";
}

struct Exported {
  run::TemporaryFolder folder;
  std::string run, out;
  Exported() : run(folder / "run"), out(folder / "set") { make_run(small_table(), run); }
};

TEST_CASE("a dataset has every frame of its run, as its own check and other readers see it") {
  const Exported made;
  DatasetOptions options = dataset_options();
  const DatasetReport report = must_export(made.run, made.out, Format::kLerobot, options);
  CHECK(report.episodes == kEpisodes);
  CHECK(report.frames == kEpisodes * kHorizon);
  CHECK(report.left_out.empty());
  CHECK(!fs::exists(made.out + ".partial"));
  CHECK(!fs::exists(made.out + "/lock"));
  const auto checked = check_dataset(made.out);
  REQUIRE_MESSAGE(checked.ok(), (checked.ok() ? "" : to_text(checked.failure())));
  for (const std::string& problem : checked->problems) CHECK_MESSAGE(problem.empty(), problem);
  CHECK(checked->frames == report.frames);

  const auto traces = traces_of(made.run);
  const Json info = Json::parse(text_of(made.out + "/meta/info.json"));
  CHECK(info["codebase_version"] == "v3.0");
  CHECK(info["features"]["observation.images.third_view"]["shape"] == Json::array({64, 96, 3}));
  CHECK(info["features"]["action"]["names"].size() == 7);

  const std::string there = readers();
  if (there.empty()) return;
  const std::string data = made.out + "/data/chunk-000/file-000.parquet";
  const std::string episodes = made.out + "/meta/episodes/chunk-000/file-000.parquet";
  const std::string tasks = made.out + "/meta/tasks.parquet";
  int status = 0;
  const std::string words = output_of(
      "cd '" + there + "' && node read.mjs '" + data + "' '" + episodes + "' '" + tasks + "' 2>&1",
      &status);
  REQUIRE_MESSAGE(status == 0, words);
  const Json read = Json::parse(words);
  for (const char* reader : {"hyparquet", "duckdb"}) {
    CAPTURE(reader);
    const Json& rows = read[data][reader]["rows"];
    REQUIRE(rows.size() == kEpisodes * kHorizon);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const store::Trace& trace = traces[i / kHorizon].trace;
      const std::size_t frame = i % kHorizon;
      const Json& row = rows[i];
      CHECK(row["index"] == i);
      CHECK(row["episode_index"] == i / kHorizon);
      CHECK(row["frame_index"] == frame);
      CHECK(row["task_index"] == 0);
      CHECK(row["next.done"] == (frame + 1 == kHorizon));
      CHECK(row["timestamp"].get<double>() == static_cast<float>(static_cast<double>(frame) / 5));
      const auto& q = frame == 0 ? trace.start->q : trace.steps[frame - 1].q;
      REQUIRE(row["action"].size() == 7);
      for (std::size_t k = 0; k < 7; ++k)
        CHECK(row["action"][k].get<double>() ==
              static_cast<double>(static_cast<float>(trace.steps[frame].action[k])));
      REQUIRE(row["observation.joints"].size() == q.size());
      for (std::size_t k = 0; k < q.size(); ++k)
        CHECK(row["observation.joints"][k].get<double>() ==
              static_cast<double>(static_cast<float>(q[k])));
    }
    const Json& of_episodes = read[episodes][reader]["rows"];
    REQUIRE(of_episodes.size() == kEpisodes);
    CHECK(of_episodes[1]["tasks"] == Json::array({traces[1].trace.header.prompt}));
    CHECK(of_episodes[1]["dataset_from_index"] == kHorizon);
    CHECK(of_episodes[1]["videos/observation.images.third_view/from_timestamp"].get<double>() ==
          kHorizon / 5.0);
    CHECK(of_episodes[0]["stats/observation.images.third_view/mean"].size() == 3);
    CHECK(of_episodes[0]["stats/action/count"] == Json::array({kHorizon}));
    CHECK(read[tasks][reader]["rows"][0]["task"] == traces[0].trace.header.prompt);
    const Json pandas = Json::parse(read[tasks][reader]["notes"]["pandas"].text());
    CHECK(pandas["index_columns"] == Json::array({"task"}));
  }
}

TEST_CASE("the video has the pictures that the policy saw, evenly spaced, as ffprobe sees it") {
  const Exported made;
  must_export(made.run, made.out, Format::kLerobot, dataset_options());
  int status = 0;
  const std::string words = output_of("ffprobe -v error -count_frames -of json -show_streams '" +
                                          made.out + "/" + kVideo + "' 2>/dev/null",
                                      &status);
  if (status == 127) {
    MESSAGE("SKIPPED: there is no ffprobe");
    return;
  }
  const Json stream = Json::parse(words)["streams"][0];
  CHECK(stream["codec_name"] == "h264");
  CHECK(stream["pix_fmt"] == "yuv420p");
  CHECK(stream["avg_frame_rate"] == "5/1");
  CHECK(stream["nb_read_frames"] == std::to_string(kEpisodes * kHorizon));
  CHECK(stream["width"] == 96);

  // Frame by frame: each is the picture of its step, but for what the codec loses.
  const std::string raw = output_of("ffmpeg -v error -i '" + made.out + "/" + kVideo +
                                    "' -f rawvideo -pix_fmt rgb24 - 2>/dev/null");
  constexpr std::size_t kBytes = 96 * 64 * 3;
  REQUIRE(raw.size() == kBytes * kEpisodes * kHorizon);
  auto plan = store::open_run_plan(made.run);
  REQUIRE(plan.ok());
  const std::uint32_t tasks[] = {0};
  const auto assets = stage::SharedAssets::load(*plan, dataset_options().assets, tasks);
  REQUIRE(assets.ok());
  Repeater repeater(*plan, *assets);
  std::size_t frame = 0;
  for (const store::StoredTrace& stored : traces_of(made.run)) {
    const auto repeated = repeater.repeat(stored.trace, [&](auto frames, const auto&, std::size_t) {
      const auto rgb = frames[0].frame.rgb;
      double apart = 0;
      for (std::size_t i = 0; i < kBytes; ++i)
        apart += std::abs(rgb[i] -
                          static_cast<int>(static_cast<unsigned char>(raw[frame * kBytes + i])));
      CHECK_MESSAGE(apart / kBytes < 6, "frame ", frame);
      ++frame;
      return Status();
    });
    REQUIRE(repeated.ok());
  }
}

TEST_CASE("the bytes do not depend on the threads, and files are cut where they get too large") {
  const Exported made;
  DatasetOptions options = dataset_options();
  options.only_success = false;
  options.most_data = 3000;
  options.most_video = 6000;
  std::map<std::string, std::string> first;
  for (const int jobs : {1, 2, 3}) {
    options.jobs = jobs;
    const std::string out = made.out + std::to_string(jobs);
    must_export(made.run, out, Format::kLerobot, options);
    const auto files = all_files(out);
    if (first.empty()) first = files;
    CHECK(files == first);
    const auto checked = check_dataset(out);
    REQUIRE(checked.ok());
    for (const std::string& problem : checked->problems) CHECK_MESSAGE(problem.empty(), problem);
  }
  CHECK(first.contains("data/chunk-000/file-001.parquet"));
  CHECK(first.contains("videos/observation.images.third_view/chunk-000/file-001.mp4"));
}

TEST_CASE("every wording is an episode of its own that shares the demonstration's video") {
  const Exported made;
  const std::string table = made.folder / "w.jsonl";
  write_wording(made.run, table);
  DatasetOptions options = dataset_options();
  options.rephrase = table;
  options.wordings = 2;
  const DatasetReport report = must_export(made.run, made.out, Format::kLerobot, options);
  CHECK(report.demonstrations == kEpisodes);
  CHECK(report.episodes == 2 * kEpisodes);
  const auto checked = check_dataset(made.out);
  REQUIRE(checked.ok());
  for (const std::string& problem : checked->problems) CHECK_MESSAGE(problem.empty(), problem);
  CHECK(Json::parse(text_of(made.out + "/meta/info.json"))["total_tasks"] == 2);
}

TEST_CASE("a size of its own is written, and what has no even sides or no such camera is refused") {
  const Exported made;
  DatasetOptions options = dataset_options();
  options.width = 32;
  options.height = 48;
  must_export(made.run, made.out, Format::kLerobot, options);
  CHECK(Json::parse(text_of(
            made.out + "/meta/info.json"))["features"]["observation.images.third_view"]["shape"] ==
        Json::array({48, 32, 3}));
  options.width = 33;
  CHECK(export_dataset({made.run}, made.out + "2", Format::kLerobot, options).failure().where ==
        "--size");
  options = dataset_options();
  options.cameras = {"wrist"};
  const auto refused = export_dataset({made.run}, made.out + "2", Format::kLerobot, options);
  CHECK(refused.failure().message.find("`third_view`") != std::string::npos);
  options = dataset_options();
  options.only_success = true;  // nobody succeeds at random
  const auto none = export_dataset({made.run}, made.out + "2", Format::kLerobot, options);
  CHECK(none.failure().message.find("no success") != std::string::npos);
  CHECK(!fs::exists(made.out + "2"));
  CHECK(!fs::exists(made.out + "2.partial"));
}

TEST_CASE("a picture, start or state that is not the stored one is told by episode and step") {
  const Exported made;
  auto plan = store::open_run_plan(made.run);
  REQUIRE(plan.ok());
  const std::uint32_t tasks[] = {0};
  const auto assets =
      stage::SharedAssets::load(*plan, std::string(VLAPROBE_SOURCE_DIR) + "/assets", tasks);
  REQUIRE(assets.ok());
  Repeater repeater(*plan, *assets);
  store::Trace trace = traces_of(made.run)[1].trace;
  const auto see = [](auto, const auto&, std::size_t) { return Status(); };
  CHECK(repeater.repeat(trace, see).ok());
  store::Trace other = trace;
  other.steps[3].image_hash.bytes[0] ^= 1;
  const Failure picture = repeater.repeat(other, see).failure();
  CHECK(picture.code == Fault::kTrace);
  CHECK(picture.where == "carrot_on_plate episode 1 seed 42");
  CHECK(picture.message.find("step 3: the picture is not the one that the policy saw") == 0);
  other = trace;
  other.steps[2].state_hash.bytes[0] ^= 1;
  CHECK(repeater.repeat(other, see).failure().message.find("step 2: its action") == 0);
  other = trace;
  other.start->state_hash.bytes[0] ^= 1;
  CHECK(!repeater.repeat(other, see).ok());
  CHECK(repeater.repeat(trace, see).ok());  // and goes on
}

TEST_CASE("folders of others are refused, what a killed export left is begun anew") {
  const Exported made;
  fs::create_directories(made.out);
  std::ofstream(made.out + "/mine.txt") << "mine";
  const auto there = export_dataset({made.run}, made.out, Format::kLerobot, dataset_options());
  CHECK(there.failure().code == Fault::kUsage);
  CHECK(text_of(made.out + "/mine.txt") == "mine");
  fs::remove_all(made.out);
  fs::create_directories(made.out + ".partial");
  std::ofstream(made.out + ".partial/mine.txt") << "mine";
  CHECK(!export_dataset({made.run}, made.out, Format::kLerobot, dataset_options()).ok());
  CHECK(text_of(made.out + ".partial/mine.txt") == "mine");
  // As nobody but a stranger leaves it.
  std::ofstream(made.out + ".mine") << "mine";
  fs::create_symlink(made.out + ".mine", made.out + ".partial/.vlaprobe-export");
  CHECK(!export_dataset({made.run}, made.out, Format::kLerobot, dataset_options()).ok());
  CHECK(text_of(made.out + ".mine") == "mine");
  fs::remove(made.out + ".partial/.vlaprobe-export");
  // As a killed export leaves it.
  std::ofstream(made.out + ".partial/.vlaprobe-export") << "";
  must_export(made.run, made.out, Format::kLerobot, dataset_options());
  CHECK(!fs::exists(made.out + "/mine.txt"));
  CHECK(!fs::exists(made.out + "/.vlaprobe-export"));
  CHECK(!fs::exists(made.out + ".partial"));
  // And as a cut of the power does, before the mark was on the disk.
  fs::remove_all(made.out);
  fs::create_directories(made.out + ".partial");
  std::ofstream(made.out + ".partial/lock") << "";
  // Or while it was written.
  std::ofstream(made.out + ".partial/.vlaprobe-export.4711-0.tmp") << "";
  must_export(made.run, made.out, Format::kLerobot, dataset_options());
  CHECK(!fs::exists(made.out + "/lock"));
  CHECK(!fs::exists(made.out + ".partial"));
}

TEST_CASE("a dataset goes to the empty folder that a link leads to") {
  const Exported made;
  fs::create_directories(made.out + ".elsewhere/empty");
  fs::create_directory_symlink(made.out + ".elsewhere/empty", made.out);
  must_export(made.run, made.out, Format::kLerobot, dataset_options());
  CHECK(fs::is_symlink(made.out));
  CHECK(fs::exists(made.out + ".elsewhere/empty/meta/info.json"));
}

TEST_CASE("a folder that a disk is mounted on is refused before anything is drawn") {
  const Exported made;
  fs::create_directories(made.out);
  enum Exit { kRefused, kElse, kCannotMount };
  const pid_t child = fork();  // with mounts of its own
  if (child == 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0 ||
        mount("none", made.out.c_str(), "tmpfs", 0, nullptr) != 0)
      _exit(kCannotMount);
    const auto done = export_dataset({made.run}, made.out, Format::kLerobot, dataset_options());
    _exit(!done && done.failure().message.starts_with("is where a disk is mounted") ? kRefused
                                                                                    : kElse);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kCannotMount) {
    MESSAGE("skipped: no disk can be mounted here");
    return;
  }
  CHECK(WEXITSTATUS(status) == kRefused);
  CHECK(!fs::exists(made.out + ".partial"));
}

// An export in a process of its own that is killed when so many demonstrations are done.
void export_and_die(const std::string& run, const std::string& out, Format format,
                    std::size_t after) {
  const pid_t child = fork();
  if (child == 0) {
    DatasetOptions options = dataset_options();
    options.progress = [&](std::size_t done, std::size_t) {
      if (done == after) kill(getpid(), SIGKILL);
    };
    (void)export_dataset({run}, out, format, options);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
}

TEST_CASE("an export that was killed goes on with what it had finished, to the same bytes") {
  const Exported made;
  for (const Format format : {Format::kLerobot, Format::kRobomimic, Format::kRlds}) {
    CAPTURE(static_cast<int>(format));
    const std::string whole = made.folder / "whole", out = made.out;
    CHECK(must_export(made.run, whole, format, dataset_options()).kept == 0);
    export_and_die(made.run, out, format, 2);
    CHECK(!fs::exists(out));
    CHECK(must_export(made.run, out, format, dataset_options()).kept >= 2);
    CHECK(all_files(out) == all_files(whole));
    CHECK(check_dataset(out)->problems.empty());
    fs::remove_all(out);
    // One that makes something else does not, nor one that finds them damaged.
    export_and_die(made.run, out, format, 2);
    DatasetOptions smaller = dataset_options();
    smaller.width = smaller.height = 32;
    CHECK(must_export(made.run, out, format, smaller).kept == 0);
    fs::remove_all(out);
    export_and_die(made.run, out, format, 2);
    std::size_t damaged = 0;
    for (const auto& entry : fs::directory_iterator(out + ".partial/finished")) {
      fs::resize_file(entry.path(), fs::file_size(entry.path()) - 1);
      ++damaged;
    }
    CHECK(damaged >= 2);
    CHECK(must_export(made.run, out, format, dataset_options()).kept == 0);
    CHECK(all_files(out) == all_files(whole));
    fs::remove_all(out);
    fs::remove_all(whole);
  }
}

TEST_CASE("a disk that is full is told by the file that it has no room for") {
  const Exported made;
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  for (const rlim_t room : {rlim_t{600}, rlim_t{3000}, rlim_t{7000}}) {
    CAPTURE(room);
    rlimit less = before;
    less.rlim_cur = room;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &less) == 0);
    const auto done = export_dataset({made.run}, made.out, Format::kLerobot, dataset_options());
    REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
    REQUIRE(!done.ok());
    CHECK((done.failure().code == Fault::kIo || done.failure().code == Fault::kVideo));
    CHECK(done.failure().where.find(made.out + ".partial/") == 0);
    CHECK(!fs::exists(made.out));
    CHECK(!fs::exists(made.out + ".partial"));
  }
  std::signal(SIGXFSZ, old);
}

TEST_CASE("a dataset that was changed, or is of another run, does not pass its check") {
  const Exported made;
  must_export(made.run, made.out, Format::kLerobot, dataset_options());
  const auto problems = [&](const std::vector<std::string>& runs = {}) {
    const auto checked = check_dataset(made.out, {.runs = runs});
    return checked ? checked->problems : std::vector<std::string>{to_text(checked.failure())};
  };
  REQUIRE(problems().empty());
  const auto with = [&](const std::string& path, const std::function<void(std::string&)>& change) {
    const std::string file = made.out + "/" + path, kept = text_of(file);
    std::string bytes = kept;
    change(bytes);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
    const auto found = problems();
    std::ofstream(file, std::ios::binary | std::ios::trunc) << kept;
    CHECK_MESSAGE(!found.empty(), path);
    return found.empty() ? std::string() : found.front();
  };
  const auto replace = [](const char* from, const char* to) {
    return [from, to](std::string& text) { text.replace(text.find(from), std::strlen(from), to); };
  };
  // A number of the first action.
  const float action = static_cast<float>(traces_of(made.run)[0].trace.steps[0].action[0]);
  const std::string number(reinterpret_cast<const char*>(&action), sizeof action);
  CHECK(with("data/chunk-000/file-000.parquet", [&](std::string& bytes) {
          bytes[bytes.find(number) + 1] ^= 1;
        }).find("episode 0 (carrot_on_plate episode 0 seed 42) frame 0: action") == 0);
  CHECK(with("meta/info.json", replace("\"total_frames\": 28", "\"total_frames\": 29"))
            .find("`total_frames` is not 28") != std::string::npos);
  with("meta/tasks.parquet", replace("carrot", "rabbit"));
  with("meta/tasks.parquet", replace("pandas", "panda_"));
  with("meta/stats.json", replace("\"count\"", "\"min\""));
  CHECK(with("meta/stats.json", [](std::string& text) {
          Json json = Json::parse(text);
          json["timestamp"]["min"] = 0.0;  // no list of one
          text = json.dump();
        }).find("`timestamp`: min is not below q01") != std::string::npos);
  with(kVideo, [](std::string& bytes) { bytes.resize(bytes.size() / 2); });
  with("vlaprobe/demonstrations.jsonl", replace("\"trace_sha256\":\"", "\"trace_sha256\":\"0"));
  with("vlaprobe/demonstrations.jsonl", [](std::string& text) {
    text.resize(text.rfind('\n', text.size() - 2) + 1);  // one demonstration less
  });
  fs::rename(made.run, made.run + "-moved");
  CHECK(problems().front().find("RUN...") != std::string::npos);
  CHECK(problems({made.run + "-moved"}).empty());
  make_run(small_table(), made.run, "null");
  CHECK(problems().front().find("another trace") != std::string::npos);
  CHECK(!check_dataset(made.run).ok());
}

// The dataset's video with its frames in another order or otherwise changed, as `frame_of` has it.
void film_again(const std::string& path, int count,
                const std::function<std::vector<std::uint8_t>(
                    const std::vector<std::vector<std::uint8_t>>& frames, int)>& frame_of) {
  std::vector<std::vector<std::uint8_t>> frames;
  auto reader = show::ClipReader::create(path);
  REQUIRE(reader.ok());
  for (;;) {
    const auto frame = (*reader)->next();
    REQUIRE(frame.ok());
    if (frame->empty()) break;
    frames.emplace_back(frame->begin(), frame->end());
  }
  REQUIRE(frames.size() == static_cast<std::size_t>(count));
  auto encoder = show::ClipEncoder::create({(*reader)->width(), (*reader)->height(), 5});
  REQUIRE(encoder.ok());
  for (int i = 0; i < count; ++i) REQUIRE((*encoder)->add(frame_of(frames, i)).ok());
  const auto clip = (*encoder)->finish();
  REQUIRE(clip.ok());
  auto joiner = show::ClipJoiner::create(path, *clip);
  REQUIRE(joiner.ok());
  REQUIRE((*joiner)->add(*clip).ok());
  REQUIRE((*joiner)->finish().ok());
}

TEST_CASE(
    "a video that shows other pictures, or the right ones a step late, does not pass its check") {
  const Exported made;
  const std::string video = made.out + "/" + kVideo;
  const auto problem = [&](const auto& frame_of, bool redraws = true) {
    fs::remove_all(made.out);
    must_export(made.run, made.out, Format::kLerobot, dataset_options());
    film_again(video, kEpisodes * kHorizon, frame_of);
    CheckOptions options;
    options.redraws = redraws;
    const auto checked = check_dataset(made.out, options);
    REQUIRE(checked.ok());
    std::string all;
    for (const std::string& one : checked->problems) all += one + "\n";
    return all;
  };
  const auto at = [](const auto& frames, int i) {
    return frames[static_cast<std::size_t>(std::clamp(i, 0, static_cast<int>(frames.size()) - 1))];
  };
  CHECK(problem([&](const auto& frames, int i) { return at(frames, i); }) == "");
  const auto late = [&](const auto& frames, int i) { return at(frames, i - 1); };
  CHECK(problem(late).find("shows what the policy saw a step earlier") != std::string::npos);
  CHECK(problem(late, false) == "");  // nobody looked
  CHECK(problem([&](const auto& frames, int i) {
          return at(frames, i + 1);
        }).find("is shown a step earlier") != std::string::npos);
  const std::string other = problem([&](const auto& frames, int i) {
    auto frame = at(frames, i);
    if (i == 3) std::ranges::reverse(frame);
    return frame;
  });
  CHECK(other.find("episode 0 (carrot_on_plate episode 0 seed 42) frame 3 of `third_view` in ") ==
        0);
  CHECK(other.find(" of 255 away from what the policy saw") != std::string::npos);
}

}  // namespace
}  // namespace probe::dataset
