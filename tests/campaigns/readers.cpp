// Whatever is read of others: whole files of each kind with one to four damages, or two of a kind
// spliced together. A reader takes them or refuses them with a reason; one that dies, takes over
// ten seconds or over a gigabyte, or has no reason to say is a finding.
//   campaign_readers [TARGET..] [--for SECONDS | --count N] [--from SEED] [--only SEED]
// A seed is one damaged file, always the same. Exit 0: no finding.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/compile/files.h"
#include "runtime/libero/bddl.h"
#include "runtime/libero/states.h"
#include "runtime/mjcf/read.h"
#include "runtime/report/published.h"
#include "runtime/robot/urdf.h"
#include "runtime/run/run.h"
#include "runtime/scene/image.h"
#include "runtime/scene/mesh_import.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/protocols/openvla.h"
#include "runtime/store/store.h"
#include "runtime/store/trace.h"
#include "runtime/wire/json.h"
#include "runtime/wire/msgpack.h"
#include "tests/campaigns/base.h"
#include "tests/campaigns/driver.h"
#include "tests/runtime/libero/small_folder.h"
#include "tests/runtime/scene/mutate.h"
#include "tests/runtime/scene/tiny_meshes.h"

namespace {

using namespace probe;
namespace fs = std::filesystem;

constexpr const char* kName = "campaign_readers";
constexpr std::size_t kLargest = std::size_t{1} << 20;  // bytes of a damaged file

struct Sample {
  std::string name;  // of the file, its ending says the form
  std::string bytes;
};

struct Target {
  const char* name;
  std::vector<Sample> samples;
  std::function<Status(const std::string& path, const std::string& bytes)> read;
};

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<Sample> files_in(const fs::path& folder, const std::string& ending,
                             std::size_t most_bytes = 100'000) {
  std::vector<Sample> samples;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ending && entry.file_size() <= most_bytes)
      samples.push_back({entry.path().filename().string(), text_of(entry.path())});
  }
  std::ranges::sort(samples, {}, &Sample::name);
  return samples;
}

std::span<const std::uint8_t> octets(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

std::string answer() {
  return R"({"actions":[[0.1,-0.2,0.3,0,0.5,-0.6,1],[0,0,0,0,0,0,-1]],"ok":true,"why":null,"text":"é"})";
}

// A run of two episodes with its database, plan and traces.
void make_run(const fs::path& folder) {
  const campaign::Base base =
      campaign::base_of(kName, VLAPROBE_SOURCE_DIR "/suite/intact.probe", "carrot_on_plate");
  run::RunOptions options;
  options.policy = "null";
  options.out = folder.string();
  options.seeds = {1};
  options.episodes = {{0, 1}};
  options.assets = campaign::asset_root();
  const auto done = run::run(base.plan, options);
  if (!done) campaign::usage(kName, to_text(done.failure()));
}

Status refused_by_compiler(const std::vector<std::string>& files,
                           std::map<std::string, std::string> unsaved) {
  compile::FilesRequest request = campaign::request();
  request.unsaved = std::move(unsaved);
  const auto compiled = compile::compile_files(files, request);
  if (!compiled) return compiled.failure();
  if (compiled->diagnostics.has_errors()) return Failure{Fault::kUsage, "has mistakes", files[0]};
  return {};
}

std::vector<Target> targets(const fs::path& work) {
  const fs::path root = VLAPROBE_SOURCE_DIR;
  std::vector<Target> all;

  all.push_back(
      {"text", files_in(root / "examples", ".probe"), [root](const auto&, const auto& bytes) {
         const std::string path = (root / "examples/damaged.probe").string();
         return refused_by_compiler({path}, {{path, bytes}});
       }});
  const std::string starts = (root / "examples/recorded_starts.csv").string();
  all.push_back(
      {"starts", {{"starts.csv", text_of(starts)}}, [root, starts](const auto&, const auto& bytes) {
         return refused_by_compiler({(root / "examples/recorded_starts.probe").string()},
                                    {{starts, bytes}});
       }});

  using namespace scene::test;
  all.push_back({"mesh",
                 {{"m.obj", obj_box()},
                  {"m.stl", stl_box()},
                  {"b.stl", binary_stl_box()},
                  {"m.dae", dae_box("Z_UP")},
                  {"m.glb", glb_file(gltf_box(""))},
                  {"c.glb", glb_file(gltf_box("", {0.5f, 0.25f, 1.0f}))}},
                 [](const auto& path, const auto&) {
                   const auto mesh = scene::load_mesh(path);
                   return mesh.ok() ? Status() : Status(mesh.failure());
                 }});
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 3 * 16 * 16; ++i) rgb.push_back(static_cast<std::uint8_t>(7 * i));
  std::vector<Sample> pictures;
  if (const auto png = scene::png_bytes(16, 16, rgb)) pictures.push_back({"p.png", *png});
  if (const auto jpeg = scene::jpeg_bytes(16, 16, rgb, 90)) pictures.push_back({"p.jpg", *jpeg});
  all.push_back({"picture", pictures, [](const auto& path, const auto&) {
                   const auto image = scene::load_image(path);
                   return image.ok() ? Status() : Status(image.failure());
                 }});
  all.push_back({"urdf", files_in(root / "assets", ".urdf"), [](const auto& path, const auto&) {
                   const auto model = robot::load_urdf(path);
                   return model.ok() ? Status() : Status(model.failure());
                 }});

  const std::string folder = probe::test::SmallFolder::model(
      "chest",
      probe::test::SmallFolder::box("0.1 0.1 0.01") +
          R"(<body name="drawer"><joint name="slide" type="slide" axis="0 1 0" range="-0.16 0.01" damping="50"/><geom type="box" size="0.08 0.08 0.005" pos="0 0 0.06" group="0" density="100"/></body>)");
  all.push_back({"mjcf", {{"chest.xml", folder}}, [](const auto& path, const auto&) {
                   const auto model = mjcf::read_model(path);
                   return model.ok() ? Status() : Status(model.failure());
                 }});
  all.push_back({"bddl",
                 {{"problem.bddl", std::string(probe::test::kSmallProblem)}},
                 [](const auto& path, const auto& bytes) {
                   const auto read = libero::read_bddl(bytes, path);
                   return read.mistakes.empty() ? Status() : Status(read.mistakes.front());
                 }});
  const auto states = probe::test::from_hex(probe::test::kSmallStates);
  all.push_back(
      {"states",
       {{"task.pruned_init", {reinterpret_cast<const char*>(states.data()), states.size()}}},
       [](const auto& path, const auto&) {
         static const libero::BddlProblem problem =
             libero::read_bddl(probe::test::kSmallProblem, "small").problem;
         const auto read = libero::read_states(path, problem, {{"chest", {"drawer_slide"}}});
         return read.ok() ? Status() : Status(read.failure());
       }});

  all.push_back({"profile", files_in(root / "runtime/servers/profiles", ".profile"),
                 [](const auto& path, const auto& bytes) {
                   const auto profile = servers::parse_profile(bytes, path);
                   return profile.ok() ? Status() : Status(profile.failure());
                 }});
  all.push_back({"table",
                 {{"published.csv", text_of(root / "suite/google/published_visual_matching.csv")}},
                 [](const auto& path, const auto& bytes) {
                   const auto table = report::parse_published(bytes, path);
                   return table.ok() ? Status() : Status(table.failure());
                 }});

  const auto value = wire::from_json(answer());
  const wire::Bytes packed = wire::to_msgpack(*value, wire::ArrayStyle{});
  all.push_back({"msgpack",
                 {{"answer", {reinterpret_cast<const char*>(packed.data()), packed.size()}}},
                 [](const auto&, const auto& bytes) {
                   const auto read = wire::from_msgpack(octets(bytes));
                   return read.ok() ? Status() : Status(read.failure());
                 }});
  all.push_back({"json", {{"answer.json", answer()}}, [](const auto&, const auto& bytes) {
                   const auto read = wire::from_json(bytes);
                   return read.ok() ? Status() : Status(read.failure());
                 }});
  all.push_back(
      {"openvla", {{"body", "[0.1,-0.2,0.3,0,0.5,-0.6,1]"}}, [](const auto&, const auto& bytes) {
         const auto read = servers::openvla_actions(bytes);
         return read.ok() ? Status() : Status(read.failure());
       }});

  const fs::path made = work / "run";
  make_run(made);
  std::vector<Sample> traces = files_in(made / "traces", ".trace", kLargest);
  all.push_back({"trace", traces, [](const auto& path, const auto&) {
                   const auto trace = store::read_trace_prefix(path);
                   return trace.ok() ? Status() : Status(trace.failure());
                 }});
  all.push_back({"database",
                 {{"results.sqlite", text_of(made / "results.sqlite")}},
                 [made](const auto&, const auto& bytes) {
                   std::ofstream(made / "results.sqlite", std::ios::binary) << bytes;
                   const auto rows = store::read_results(made.string());
                   return rows.ok() ? Status() : Status(rows.failure());
                 }});
  all.push_back({"plan of a run",
                 {{"suite.plan", text_of(made / "suite.plan")}},
                 [](const auto& path, const auto&) {
                   const auto plan = plan::Plan::open(path);
                   return plan.ok() ? Status() : Status(plan.failure());
                 }});
  return all;
}

// Of two samples of a form the head of one and the tail of the other, or one of them; damaged.
Sample damaged(const Target& target, std::uint64_t seed) {
  scene::test::Dice dice(seed * 0x9e3779b97f4a7c15ull);
  const Sample& one = target.samples[dice.below(target.samples.size())];
  Sample out = one;
  const Sample& other = target.samples[dice.below(target.samples.size())];
  if (dice.below(8) == 0 && fs::path(one.name).extension() == fs::path(other.name).extension() &&
      !other.bytes.empty() && !one.bytes.empty()) {
    out.bytes = one.bytes.substr(0, dice.below(one.bytes.size())) +
                other.bytes.substr(dice.below(other.bytes.size()));
  }
  out.bytes = scene::test::mutated(std::move(out.bytes), seed);
  if (out.bytes.size() > kLargest) out.bytes.resize(kLargest);
  return out;
}

// By this process and those that it waited for, where files are parsed apart.
struct Spent {
  long most_kb = 0;
  double seconds = 0;
};
Spent spent() {
  Spent all;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(who, &used);
    all.most_kb = std::max(all.most_kb, used.ru_maxrss);
    for (const timeval& time : {used.ru_utime, used.ru_stime})
      all.seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const campaign::Options options = campaign::read_options(kName, argc, argv);
  const fs::path work =
      fs::temp_directory_path() / ("vlaprobe_readers_" + std::to_string(getpid()));
  fs::create_directories(work);
  std::vector<Target> all = targets(work);
  const auto leave = [&](const std::string& why) {
    std::error_code error;
    fs::remove_all(work, error);
    campaign::usage(kName, why);
  };
  std::erase_if(all, [&](const Target& target) {
    return !options.words.empty() &&
           std::ranges::find(options.words, target.name) == options.words.end();
  });
  for (const Target& target : all) {
    if (target.samples.empty()) leave(std::string(target.name) + " has no file to damage");
  }
  if (all.empty()) leave("no such target");
  const int exit = campaign::run(
      options, {.seconds = 20, .memory = rlim_t{4} << 30},
      [&](campaign::Tally& tally) {
        const std::size_t which = tally.seed % all.size();
        const Target& target = all[which];
        const Sample file = damaged(target, tally.seed);
        const std::string path = (work / file.name).string();
        std::ofstream(path, std::ios::binary) << file.bytes;
        const auto before = spent();
        const Status status = target.read(path, file.bytes);
        const auto after = spent();
        ++tally.counts[2 * which + (status.ok() ? 0 : 1)];
        if (!status.ok() &&
            (status.failure().message.empty() || status.failure().code == Fault::kInternal))
          tally.find(std::string(target.name) +
                     ": a refusal without a reason: " + to_text(status.failure()));
        if (after.most_kb - before.most_kb > (1 << 20))
          tally.find(std::string(target.name) + ": took over a gigabyte");
        if (after.seconds - before.seconds > 10)
          tally.find(std::string(target.name) + ": took over ten seconds");
      },
      [&](const campaign::Tally& tally) {
        for (std::size_t i = 0; i < all.size(); ++i)
          std::printf("%-14s %9llu taken %9llu refused\n", all[i].name,
                      static_cast<unsigned long long>(tally.counts[2 * i]),
                      static_cast<unsigned long long>(tally.counts[2 * i + 1]));
      });
  std::error_code error;
  fs::remove_all(work, error);
  return exit;
}
