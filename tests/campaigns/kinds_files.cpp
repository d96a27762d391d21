// Files that are read one by one: texts, tables, meshes, pictures, robots, models of MuJoCo,
// LIBERO's problems and states, profiles, manifests, plans, traces.
#include <tuple>

#include "runtime/assets/manifest.h"
#include "runtime/base/json.h"
#include "runtime/base/sha256.h"
#include "runtime/compile/files.h"
#include "runtime/export/dataset/wordings.h"
#include "runtime/libero/bddl.h"
#include "runtime/libero/states.h"
#include "runtime/mjcf/mesh_file.h"
#include "runtime/mjcf/read.h"
#include "runtime/report/agreement.h"
#include "runtime/report/published.h"
#include "runtime/robot/urdf.h"
#include "runtime/scene/image.h"
#include "runtime/scene/mesh_import.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transcript.h"
#include "tests/campaigns/base.h"
#include "tests/campaigns/kinds.h"
#include "tests/runtime/libero/small_folder.h"
#include "tests/runtime/mjcf/mjcf_files.h"
#include "tests/runtime/scene/tiny_meshes.h"

namespace probe::campaign {
namespace {

namespace fs = std::filesystem;

Status refused_by_compiler(const std::vector<std::string>& files,
                           std::map<std::string, std::string> unsaved) {
  compile::FilesRequest wanted = request();
  wanted.unsaved = std::move(unsaved);
  const auto compiled = compile::compile_files(files, wanted);
  if (!compiled) return compiled.failure();
  if (compiled->diagnostics.has_errors()) return Failure{Fault::kUsage, "has mistakes", files[0]};
  return {};
}

std::vector<Sample> pictures() {
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 3 * 16 * 16; ++i) rgb.push_back(static_cast<std::uint8_t>(7 * i));
  std::vector<Sample> samples;
  if (const auto png = scene::png_bytes(16, 16, rgb)) samples.push_back({"p.png", *png});
  if (const auto jpeg = scene::jpeg_bytes(16, 16, rgb, 90)) samples.push_back({"p.jpg", *jpeg});
  return samples;
}

void add_shapes(std::vector<Kind>& kinds, const fs::path& root) {
  using namespace scene::test;
  kinds.push_back({"mesh",
                   {{"m.obj", obj_box()},
                    {"m.stl", stl_box()},
                    {"b.stl", binary_stl_box()},
                    {"m.dae", dae_box("Z_UP")},
                    {"m.glb", glb_file(gltf_box(""))},
                    {"c.glb", glb_file(gltf_box("", {0.5f, 0.25f, 1.0f}))}},
                   [](const Given& file) { return status_of(scene::load_mesh(file.path)); }});
  kinds.push_back(
      {"msh",
       {{"box.msh", mjcf::box_msh(1, 2, 3)}, {"uv.msh", mjcf::box_msh(1, 2, 3, true)}},
       [](const Given& file) { return status_of(mjcf::msh_mesh(file.bytes, file.path)); }});
  kinds.push_back({"picture", pictures(),
                   [](const Given& file) { return status_of(scene::load_image(file.path)); }});
  kinds.push_back({"urdf", files_in(root / "assets", ".urdf"),
                   [](const Given& file) { return status_of(robot::load_urdf(file.path)); }});
  const std::string chest = probe::test::SmallFolder::model(
      "chest",
      probe::test::SmallFolder::box("0.1 0.1 0.01") +
          R"(<body name="drawer"><joint name="slide" type="slide" axis="0 1 0" range="-0.16 0.01" damping="50"/><geom type="box" size="0.08 0.08 0.005" pos="0 0 0.06" group="0" density="100"/></body>)");
  kinds.push_back({"mjcf", {{"chest.xml", chest}}, [](const Given& file) {
                     return status_of(mjcf::read_model(file.path));
                   }});
}

void add_libero(std::vector<Kind>& kinds) {
  kinds.push_back(
      {"bddl", {{"problem.bddl", std::string(probe::test::kSmallProblem)}}, [](const Given& file) {
         const auto read = libero::read_bddl(file.bytes, file.path);
         return read.mistakes.empty() ? Status() : Status(read.mistakes.front());
       }});
  const auto states = probe::test::from_hex(probe::test::kSmallStates);
  kinds.push_back(
      {"states",
       {{"task.pruned_init", {reinterpret_cast<const char*>(states.data()), states.size()}}},
       [](const Given& file) {
         static const libero::BddlProblem problem =
             libero::read_bddl(probe::test::kSmallProblem, "small").problem;
         return status_of(libero::read_states(file.path, problem, {{"chest", {"drawer_slide"}}}));
       }});
}

// Rates as `compare --with` takes them.
constexpr const char* kRates =
    "source,protocol,metric,policy,task,subtask,value,trials\n"
    "paper,real,success_rate,RT-1,drawer,open,0.815,27\n"
    "paper,real,success_rate,RT-1-X,drawer,open,0.741,27\n"
    "paper,real,success_rate,Octo,drawer,open,0.148,27\n"
    "paper,variants,success_rate,RT-1,drawer,open,0.6,189\n"
    "paper,variants,success_rate,RT-1-X,drawer,open,0.296,189\n"
    "paper,variants,success_rate,Octo,drawer,open,0.0,189\n"
    "paper,variants,MMRV,all,drawer,open,0.0,\n";

// As `rephrase` writes it.
std::string wordings() {
  const auto hash = [](const std::string& text) { return to_hex(sha256(std::string_view(text))); };
  std::string lines;
  for (const auto& [wording, split, probability] :
       {std::tuple("lay the carrot on the plate", "train", 0.25),
        std::tuple("set carrot onto plate", "train", 0.5),
        std::tuple("place it", "held_out", 0.0)}) {
    const Json line = {{"task", "carrot_on_plate"},
                       {"original", "put carrot on plate"},
                       {"wording", wording},
                       {"split", split},
                       {"probability", probability},
                       {"original_probability", 0.25},
                       {"template", nullptr},
                       {"source_as", "root"},
                       {"uses", Json::array({"lang_action"})},
                       {"original_sha256", hash("put carrot on plate")},
                       {"wording_sha256", hash(wording)},
                       {"made_from_sha256", hash("text")},
                       {"starts_sha256", hash("starts")}};
    lines += line.dump() + "\n";
  }
  return lines;
}

void add_tables(std::vector<Kind>& kinds, const fs::path& root) {
  kinds.push_back(
      {"table",
       {{"published.csv", text_of(root / "suite/google/published_visual_matching.csv")}},
       [](const Given& file) {
         return status_of(report::parse_published(file.bytes, file.path));
       }});
  kinds.push_back({"rates", {{"rates.csv", kRates}}, [](const Given& file) -> Status {
                     PROBE_ASSIGN(const report::RateTable table,
                                  report::parse_rate_table(file.bytes, file.path));
                     report::agreement_text(table);
                     report::agreement_json(table).dump();
                     report::impossible_rates(table);
                     return {};
                   }});
  kinds.push_back(
      {"wordings", {{"words.jsonl", wordings()}}, [](const Given& file) -> Status {
         PROBE_ASSIGN(const dataset::Wordings words, dataset::Wordings::read(file.path));
         words.draw(
             {"carrot_on_plate", "put carrot on plate", to_hex(sha256(std::string_view("starts")))},
             4, "key");
         return {};
       }});
}

}  // namespace

void add_files(std::vector<Kind>& kinds, const fs::path& work) {
  const fs::path root = VLAPROBE_SOURCE_DIR;
  kinds.push_back({"text", files_in(root / "examples", ".probe"), [root](const Given& file) {
                     const std::string path = (root / "examples/damaged.probe").string();
                     return refused_by_compiler({path}, {{path, file.bytes}});
                   }});
  const std::string starts = (root / "examples/recorded_starts.csv").string();
  kinds.push_back({"starts", {{"starts.csv", text_of(starts)}}, [root, starts](const Given& file) {
                     return refused_by_compiler(
                         {(root / "examples/recorded_starts.probe").string()},
                         {{starts, file.bytes}});
                   }});
  add_shapes(kinds, root);
  add_libero(kinds);
  kinds.push_back(
      {"profile", files_in(root / "runtime/servers/profiles", ".profile"),
       [](const Given& file) { return status_of(servers::parse_profile(file.bytes, file.path)); }});
  add_tables(kinds, root);
  kinds.push_back({"transcript", files_in(root / "tests/servers/transcripts", ".transcript"),
                   [](const Given& file) -> Status {
                     PROBE_ASSIGN(const servers::Transcript read,
                                  servers::parse_transcript(file.bytes, file.path));
                     servers::to_text(read, true);
                     return {};
                   }});
  const fs::path assets = work / "assets";
  fs::create_directories(assets);
  assets::Manifest manifest;
  manifest.files = {{"meshes/can.glb", {1234, std::string(64, 'a'), "assets/make"}},
                    {"robots/arm.urdf", {99, std::string(64, '0'), ""}}};
  kinds.push_back(
      {"manifest", {{"manifest.json", manifest.to_json()}}, [assets](const Given& file) {
         write_text(assets / "manifest.json", file.bytes);
         return status_of(assets::read_manifest(assets.string()));
       }});
}

}  // namespace probe::campaign
