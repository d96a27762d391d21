// What verbs leave behind and others read: runs, folders of answers, searches, datasets. One file
// of a good folder is damaged in its place, and made good again.
#include "runtime/ask/answers.h"
#include "runtime/ask/ask.h"
#include "runtime/export/dataset/check.h"
#include "runtime/export/dataset/dataset.h"
#include "runtime/report/benchmark.h"
#include "runtime/report/page_data.h"
#include "runtime/report/search_findings.h"
#include "runtime/run/run.h"
#include "runtime/search/search.h"
#include "runtime/show/clip.h"
#include "runtime/store/database.h"
#include "runtime/store/store.h"
#include "runtime/store/trace.h"
#include "tests/campaigns/base.h"
#include "tests/campaigns/kinds.h"
#include "tests/runtime/ask/asking_plan.h"
#include "tests/runtime/report/fake_searches.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/scene/mutate.h"

namespace probe::campaign {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargest = std::size_t{1} << 20;

// A file of a folder that is otherwise good; also of one where a reader died before it was made
// good again.
class InItsPlace {
 public:
  InItsPlace(const fs::path& folder, const Given& file)
      : path_(folder / file.name), kept_(folder.string() + ".kept") {
    if (fs::exists(kept_ / "name")) {
      const fs::path before = text_of(kept_ / "name");
      fs::copy_file(kept_ / "good", before, fs::copy_options::overwrite_existing);
    }
    fs::create_directories(kept_);
    fs::copy_file(path_, kept_ / "good", fs::copy_options::overwrite_existing);
    write_text(kept_ / "name", path_.string());
    write_text(path_, file.bytes);
  }
  ~InItsPlace() {
    fs::copy_file(kept_ / "good", path_, fs::copy_options::overwrite_existing);
    fs::remove(kept_ / "name");
  }
  InItsPlace(const InItsPlace&) = delete;
  InItsPlace& operator=(const InItsPlace&) = delete;

 private:
  fs::path path_, kept_;
};

// Half of the damages of a database are the values of a cell, which pages that are damaged seldom
// come to.
std::string damaged_database(const fs::path& place, std::string bytes, std::uint64_t seed) {
  scene::test::Dice dice(seed ^ 0x27d4eb2f);
  if (dice.below(2) == 0) return damaged(std::move(bytes), Form::kBytes, seed);
  static constexpr const char* kOdd[] = {"NULL",
                                         "''",
                                         "-1",
                                         "0",
                                         "1e308",
                                         "9e999",
                                         "9223372036854775807",
                                         "-9223372036854775808",
                                         "4294967296",
                                         "'a'",
                                         "x'00ff00'",
                                         "'[1,2'",
                                         "'{\"a\":1}'",
                                         "'../../x'",
                                         "zeroblob(100000)",
                                         "replace(hex(zeroblob(30000)),'0','[')"};
  write_text(place, bytes);
  {
    auto database = store::Database::open(place.string(), store::Database::Access::kWrite);
    if (!database) return bytes;
    std::vector<std::pair<std::string, std::string>> cells;  // of which table, and what
    {
      store::Statement all(*database,
                           "SELECT m.name, c.name FROM sqlite_schema m, pragma_table_info(m.name) "
                           "c WHERE m.type = 'table'");
      while (all.next()) cells.emplace_back(all.text(0), all.text(1));
    }
    if (cells.empty()) return damaged(std::move(bytes), Form::kBytes, seed);
    for (std::size_t changes = 1 + dice.below(3); changes > 0; --changes) {
      const auto& [table, column] = cells[dice.below(cells.size())];
      const std::string row = " WHERE rowid = (SELECT rowid FROM \"" + table +
                              "\" ORDER BY rowid LIMIT 1 OFFSET " + std::to_string(dice.below(3)) +
                              ")";
      std::string sql = "UPDATE OR IGNORE \"" + table + "\" SET \"" + column +
                        "\" = " + kOdd[dice.below(std::size(kOdd))] + row;
      const std::size_t what = dice.below(8);
      if (what == 0) sql = "DELETE FROM \"" + table + "\"" + row;
      if (what == 1)
        sql = "UPDATE OR IGNORE \"" + table + "\" SET \"" + column + "\" = substr(\"" + column +
              "\", 2)" + row;
      if (what == 2) sql = "ALTER TABLE \"" + table + "\" DROP COLUMN \"" + column + "\"";
      if (const Status done = database->execute(sql.c_str()); !done.ok()) continue;
    }
  }
  return text_of(place);
}

Status made_run(const fs::path& folder) {
  const Base base =
      base_of("campaign_readers", VLAPROBE_SOURCE_DIR "/suite/intact.probe", "carrot_on_plate");
  run::RunOptions options;
  options.policy = "null";
  options.out = folder.string();
  options.seeds = {1};
  options.episodes = {{0, 1}};
  options.assets = asset_root();
  return status_of(run::run(base.plan, options));
}

void add_run(std::vector<Kind>& kinds, const fs::path& work) {
  const fs::path made = work / "run";
  make_apart("a run", [&] { return made_run(made); });
  kinds.push_back({"trace", files_in(made / "traces", ".trace", kLargest), [](const Given& file) {
                     return status_of(store::read_trace_prefix(file.path));
                   }});
  const fs::path scratch = work / "damaged.sqlite";
  kinds.push_back({"database",
                   {{"results.sqlite", text_of(made / "results.sqlite")}},
                   [made](const Given& file) {
                     const InItsPlace placed(made, file);
                     return status_of(store::read_results(made.string()));
                   },
                   [scratch](std::string bytes, std::uint64_t seed) {
                     return damaged_database(scratch, std::move(bytes), seed);
                   }});
  kinds.push_back({"plan of a run",
                   {{"suite.plan", text_of(made / "suite.plan")}},
                   [](const Given& file) { return status_of(plan::Plan::open(file.path)); }});
  kinds.push_back({"floors",
                   {{"floors.csv", text_of(fs::path(VLAPROBE_SOURCE_DIR) / "suite/floors.csv")}},
                   [made](const Given& file) -> Status {
                     static auto loaded = report::load(std::vector<std::string>{made.string()});
                     if (!loaded) return loaded.failure();
                     loaded->notes.clear();
                     report::Tables tables;
                     return report::add_floors(file.path, *loaded, tables);
                   }});
}

void add_answers(std::vector<Kind>& kinds, const fs::path& work) {
  const fs::path made = work / "answers";
  make_apart("a folder of answers", [&] {
    ask::AskOptions options;
    options.model = "truth";
    options.out = made.string();
    options.assets = asset_root();
    return status_of(ask::ask(ask::asking_plan(2), options));
  });
  const fs::path scratch = work / "damaged.sqlite";
  kinds.push_back(
      {"answers",
       {{"answers.sqlite", text_of(made / "answers.sqlite")}},
       [made](const Given& file) -> Status {
         const InItsPlace placed(made, file);
         PROBE_TRY(status_of(ask::read_ask_record(made.string())));
         PROBE_TRY(status_of(ask::read_ask_calls(made.string())));
         PROBE_TRY(ask::for_each_left_out(
             made.string(), [](const ask::LeftOut&, std::uint32_t) { return Status(); }));
         PROBE_TRY(status_of(ask::read_answers(made.string())));
         return status_of(report::load(std::vector<std::string>{made.string()}));
       },
       [scratch](std::string bytes, std::uint64_t seed) {
         return damaged_database(scratch, std::move(bytes), seed);
       }});
}

void add_search(std::vector<Kind>& kinds, const fs::path& work) {
  const fs::path made = work / "search", text = work / "space.probe";
  write_text(text, "use \"" VLAPROBE_SOURCE_DIR
                   "/suite/intact_clean.probe\"\nspace around of carrot_on_plate {\n"
                   "light ambient 0.05 .. 0.6\nplace source in disc 2cm\n}\n");
  make_apart("a search", [&] {
    search::SearchOptions options;
    options.text = {text.string(), "", asset_root(), VLAPROBE_SOURCE_DIR "/dsl"};
    options.run.policy = "null";
    options.run.assets = asset_root();
    options.run.out = (made / "boundary").string();
    options.levels = 3;
    options.error = 0.5;
    options.budget = 2;
    options.proves = false;
    std::string said;
    return status_of(search::search(options, said));
  });
  // What takes hundreds of trials to find.
  using namespace probe::test;
  for (const auto& [name, json] :
       {std::pair("found", boundary_json("pi0", 0.12)), std::pair("axes", axes_json("pi0")),
        std::pair("worst", worst_json("pi0", Json::array({case_json("p1", "clutter 2", true)})))}) {
    fs::create_directories(made / name);
    write_text(made / name / "search.json", json.dump(1));
  }
  std::vector<Sample> samples = files_in(made, ".json");
  for (Sample& table : files_in(made, ".csv")) samples.push_back(std::move(table));
  std::erase_if(samples, [](const Sample& sample) {
    return !sample.name.ends_with("search.json") && !sample.name.ends_with("points.csv");
  });
  kinds.push_back({"search", std::move(samples), [made](const Given& file) -> Status {
                     const InItsPlace placed(made, file);
                     const std::string folder = (made / *fs::path(file.name).begin()).string();
                     PROBE_TRY(status_of(search::read_search(folder)));
                     PROBE_ASSIGN(const report::SearchFindings found,
                                  report::read_findings(folder));
                     for (const report::Tolerance& side : found.sides) side.in_words();
                     return {};
                   }});
}

// Small enough for a campaign: two episodes of three steps, pictures of 32 x 32.
Status made_datasets(const fs::path& folder) {
  run::TablePlan table(VLAPROBE_SOURCE_DIR "/assets");
  PROBE_ASSIGN(auto bytes, table.write(2, 3, [](plan::Records& records) {
    for (plan::CameraRecord& camera : records.cameras) camera.width = camera.height = 32;
  }));
  PROBE_ASSIGN(const plan::Plan plan, plan::Plan::from_bytes(std::move(bytes)));
  run::RunOptions options;
  options.policy = "random";
  options.out = (folder / "run").string();
  options.seeds = {42};
  options.assets = asset_root();
  PROBE_TRY(status_of(run::run(plan, options)));
  dataset::DatasetOptions wanted;
  wanted.assets = asset_root();
  for (const auto& [name, format] : {std::pair("lerobot", dataset::Format::kLerobot),
                                     std::pair("robomimic", dataset::Format::kRobomimic),
                                     std::pair("rlds", dataset::Format::kRlds)})
    PROBE_TRY(status_of(
        dataset::export_dataset({options.out}, (folder / name).string(), format, wanted)));
  return {};
}

void add_datasets(std::vector<Kind>& kinds, const fs::path& work) {
  const fs::path made = work / "datasets";
  fs::create_directories(made);
  make_apart("datasets", [&] { return made_datasets(made); });
  for (const auto& [name, format] :
       {std::pair("lerobot dataset", "lerobot"), std::pair("robomimic", "robomimic"),
        std::pair("rlds", "rlds")}) {
    std::vector<Sample> samples = files_in(made / format, "", kLargest);
    std::erase_if(samples, [](const Sample& sample) {
      return sample.name.ends_with(".md") || sample.name.ends_with(".mp4");
    });
    const fs::path folder = made / format;
    kinds.push_back({name, std::move(samples), [folder](const Given& file) -> Status {
                       const InItsPlace placed(folder, file);
                       PROBE_ASSIGN(const dataset::CheckReport checked,
                                    dataset::check_dataset(folder.string(), {.redraws = false}));
                       if (checked.problems.empty()) return {};
                       return Failure{Fault::kUsage, checked.problems.front(), folder.string()};
                     }});
  }
  kinds.push_back(
      {"video", files_in(made / "lerobot", ".mp4", kLargest), [](const Given& file) -> Status {
         PROBE_TRY(status_of(show::read_video_facts(file.path)));
         PROBE_ASSIGN(const auto film, show::ClipReader::create(file.path));
         for (int frames = 0; frames < 100; ++frames) {
           PROBE_ASSIGN(const auto rgb, film->next());
           if (rgb.empty()) break;
         }
         return {};
       }});
}

}  // namespace

void add_folders(std::vector<Kind>& kinds, const fs::path& work) {
  add_run(kinds, work);
  add_answers(kinds, work);
  add_search(kinds, work);
  add_datasets(kinds, work);
}

}  // namespace probe::campaign
