// The table of an import: of a small folder of our own with records that are made here, and of the
// reference.
#include "runtime/libero/fidelity.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "runtime/libero/recorded_view.h"
#include "runtime/scene/image.h"
#include "tests/runtime/libero/imported.h"
#include "tests/runtime/libero/small_folder.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::libero {
namespace {

namespace fs = std::filesystem;

const FidelityRow& row_of(const std::vector<FidelityRow>& rows, std::string_view what) {
  const auto at = std::ranges::find(rows, what, &FidelityRow::what);
  REQUIRE(at != rows.end());
  return *at;
}

// The recorded table of tasks with the small folder's one task in it.
std::string tasks_json(const std::string& words) {
  return R"({"tasks":[{"suite":"libero_90","index":0,"file":")" + std::string(test::kSmallTask) +
         R"(.bddl","language":")" + words + R"(","horizon":400,
 "goal":[["in","cup_1","chest_1_drawer"],["close","chest_1_drawer"]],
 "problem":"Libero_Kitchen_Tabletop_Manipulation","workspace":"bench",
 "regions":{"chest_1_drawer":{"target":"chest_1","ranges":[]}},
 "objects":{"cup_1":{"cls":"Cup"},"cup_2":{"cls":"Cup"},"lid_1":{"cls":"Lid"}},
 "fixtures":{"chest_1":{"cls":"Chest","joints":["chest_1_drawer_slide"]}}}]})";
}

// Boxes of 100 kg/m3; the drawer's site has half sizes `site`.
std::string classes_json(double cup_mass, const std::string& site = "0.07 0.06 0.03") {
  const auto box = [](const char* name, double mass, double x, double y, double z, double at) {
    return fmt::format(
        R"({{"name":"{}","mass":{},"ipos":[0,0,{}],"iquat":[1,0,0,0],"inertia":[{},{},{}]}})", name,
        mass, at, mass / 3 * (y * y + z * z), mass / 3 * (x * x + z * z),
        mass / 3 * (x * x + y * y));
  };
  const std::string main =
      R"("bodies":[{"name":"main","pos":null,"quat":null,"joints":[],"sites":[]})";
  return "{\"Cup\":{" + main + "],\"compiled_bodies\":[" +
         box("main", cup_mass, 0.03, 0.03, 0.04, 0.04) + "]},\"Lid\":{" + main +
         "],\"compiled_bodies\":[" + box("main", 0.0128, 0.04, 0.04, 0.01, 0.04) +
         "]},\"Chest\":{" + main +
         R"(,{"name":"drawer","parent":"main","pos":null,"joints":[{"name":"drawer_slide","type":"slide"}],
 "sites":[{"name":"drawer","pos":"0 0 0.1","quat":"0.7071068 0 0.7071068 0","size":")" +
         site + R"("}]}],"compiled_bodies":[)" +
         box("chest_1_drawer", 0.0256, 0.08, 0.08, 0.005, 0.06) + "]}}";
}

TEST_CASE("a folder that is no import is refused before anything is measured") {
  const run::TemporaryFolder folder;
  std::ofstream(folder / "other.probe") << "suite s {}\n";
  for (const std::string& import : {folder / "", folder / "nowhere"}) {
    FidelityOptions options;
    options.import = import;
    const auto rows = measure_fidelity(options);
    REQUIRE(!rows.ok());
    CHECK(rows.failure().code == Fault::kUsage);
    CHECK(rows.failure().where == import);
    CHECK(rows.failure().message.starts_with("is no folder that `libero import` made"));
  }
}

FidelityOptions small_options(const test::SmallFolder& folder) {
  FidelityOptions options;
  options.import = (folder.root / "out").string();
  options.original = folder.root.string();
  options.records = (folder.root / "records").string();
  return options;
}

// The state of our own world behind the waiting steps, as a record has it; its first cup moved by
// `off` (m).
std::vector<double> settled_state(stage::Stage& stage, std::uint32_t start, double off) {
  REQUIRE(stage.reset(start).ok());
  std::vector<double> row{0.0};
  row.insert(row.end(), stage.q().begin(), stage.q().begin() + 9);
  row[9] = -row[9];  // the second finger counts downwards
  for (const char* object : {"cup_1", "cup_2", "lid_1"}) {
    const auto& names = stage.body_names();
    const auto at = std::ranges::find(names, object) - names.begin();
    const Pose& pose = stage.objects()[static_cast<std::size_t>(at)];
    for (int k = 0; k < 3; ++k) row.push_back(pose.position[k]);
    if (std::string_view(object) == "cup_1") row[10] += off;
    const Quat& q = pose.rotation;
    row.insert(row.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  row.push_back(stage.q().back());
  return row;
}

std::unique_ptr<stage::Stage> small_stage(Imported& imported) {
  auto stage = imported.stage("libero_90", RecordedTask{"", test::kSmallTask, 0, {}}.name(),
                              {.pictures = false});
  REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
  return std::move(stage).value();
}

// The settled states that our own world has, moved by `off` for the second start's first thing.
void write_settled(const test::SmallFolder& folder, double off) {
  Imported imported((folder.root / "out").string());
  const auto stage = small_stage(imported);
  const std::vector<std::vector<double>> rows{settled_state(*stage, 0, 0),
                                              settled_state(*stage, 1, off)};
  folder.write("records/libero_settled.npz", test::stored_zip("libero_90_00.npy", test::npy(rows)));
}

// The state in which the pictures of write_pictures() were drawn, its first cup moved by `off` (m).
void write_state(const test::SmallFolder& folder, double off) {
  Imported imported((folder.root / "out").string());
  const auto stage = small_stage(imported);
  std::string row;
  for (const double value : settled_state(*stage, 0, off))
    row += fmt::format("{}{:.17g}", row.empty() ? "" : ", ", value);
  folder.write("records/reference/libero_90_00_state.json", "{\"state_t10\": [" + row + "]}");
}

// What our own cameras see behind the waiting steps, as recorded pictures; and where the episode
// begins, as recorded geoms, those of cup_1 `off` pixels aside.
void write_pictures(const test::SmallFolder& folder, int off, int brighter) {
  Imported imported((folder.root / "out").string());
  const std::string name = RecordedTask{"", test::kSmallTask, 0, {}}.name();
  const auto stage = imported.stage("libero_90", name, {});
  REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
  REQUIRE((*stage)->reset(0).ok());
  const auto seen = (*stage)->observe();
  REQUIRE(seen.ok());
  for (const policy::CameraImage& view : seen->cameras) {
    std::vector<std::uint8_t> rgb(view.image.rgb.begin(), view.image.rgb.end());
    for (std::uint8_t& byte : rgb) byte = static_cast<std::uint8_t>(std::min(255, byte + brighter));
    const auto png = scene::png_bytes(view.image.width, view.image.height, rgb);
    REQUIRE(png.ok());
    folder.write(fmt::format("records/reference/libero_90_00_t10_{}.png", view.camera), *png);
  }
  const auto plan = imported.plan("libero_90");
  REQUIRE(plan.ok());
  std::vector<std::pair<std::string, std::string>> arrays;
  std::string bodies;
  const std::vector<std::string> names = {"cup_1_main", "cup_2_main", "lid_1_main", "room"};
  for (const std::string& body : names) {
    for (std::size_t i = 0; i < 12; ++i) {
      bodies += i < body.size() ? body[i] : '\0';
      bodies += std::string(3, '\0');
    }
  }
  arrays.emplace_back("geom_body.npy", test::npy("<U12", "(4,)", bodies));
  const auto single = imported.stage("libero_90", name, {.image = {.is_single = true}});
  REQUIRE(single.ok());
  const auto frames = first_frames(**plan, **single);
  REQUIRE(frames.ok());
  for (const stage::CameraFrame& view : *frames) {
    std::string geoms;
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 256; ++x) {
        const auto shown = [&](int at) {
          const int body =
              view.frame.segmentation[static_cast<std::size_t>(256 * y + std::clamp(at, 0, 255))] -
              1;
          const auto& all = (*stage)->body_names();
          const std::string of = body >= 0 && body < static_cast<int>(all.size())
                                     ? all[static_cast<std::size_t>(body)] + "_main"
                                     : "room";
          const auto found = std::ranges::find(names, of);
          return static_cast<int>((found == names.end() ? names.end() - 1 : found) - names.begin());
        };
        int geom = shown(x);
        if (geom == 0) geom = 3;
        if (shown(x - off) == 0) geom = 0;
        const bool is_site = x >= 120 && x < 124;  // no geom is named where one is in the way
        geoms += is_site ? '\xff' : static_cast<char>(geom);
        geoms += is_site ? '\xff' : '\0';
      }
    }
    arrays.emplace_back(
        (view.camera == "wrist" ? "robot0_eye_in_hand" : "agentview") + std::string("_geom.npy"),
        test::npy("<i2", "(256, 256)", geoms));
  }
  folder.write("records/reference/libero_90_00_t0_geometry.npz", test::stored_zip(arrays));
}

}  // namespace

TEST_CASE(
    "rules, masks and pictures of a small import: held by what it is, missed by what is not") {
  const test::SmallFolder folder;
  REQUIRE(folder.import().ok());
  folder.write("records/libero_tasks.json", tasks_json("fill the drawer and close it"));
  folder.write("records/libero_object_classes.json", classes_json(0.0288));
  write_settled(folder, 0);
  write_pictures(folder, 0, 0);
  write_state(folder, 0);
  FidelityOptions options = small_options(folder);
  options.sheets = (folder.root / "sheets").string();
  auto rows = measure_fidelity(options);
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  for (const char* what : {"rules of success", "masks of objects", "pictures of recorded states",
                           "first pictures of a policy"}) {
    CAPTURE(what);
    for (const std::string& other : row_of(*rows, what).others) CHECK(other == "");
    CHECK(row_of(*rows, what).held == Held::kYes);
  }
  CHECK(row_of(*rows, "rules of success")
            .figure.starts_with("0 unequal; 2 stored, 2 settled and 2 made-up states"));
  CHECK(row_of(*rows, "masks of objects").figure.find("1.000 in the median") != std::string::npos);
  for (const char* what : {"pictures of recorded states", "first pictures of a policy"})
    CHECK(row_of(*rows, what).figure.starts_with("2 pictures: 0.0 in the median"));
  const auto sheet = scene::load_image(options.sheets + "/libero_90_00_agentview.png");
  REQUIRE(sheet.ok());
  CHECK(sheet->width == 3 * 256);
  CHECK(sheet->rgba[4 * 2 * 256] == 128);

  // Another drawer, a cup that is seen aside, a brighter room.
  folder.write("records/libero_object_classes.json", classes_json(0.0288, "0.5 0.5 0.5"));
  write_pictures(folder, 6, 20);
  rows = measure_fidelity(options);
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  for (const char* what : {"rules of success", "masks of objects", "pictures of recorded states",
                           "first pictures of a policy"}) {
    CAPTURE(what);
    CHECK(row_of(*rows, what).held == Held::kNo);
    REQUIRE(!row_of(*rows, what).others.empty());
    CHECK(row_of(*rows, what).others[0].starts_with("libero_90_00"));
  }
  CHECK(row_of(*rows, "masks of objects").others[0].find(": cup_1 0.") != std::string::npos);
}

TEST_CASE("pictures are drawn in the recorded state, also where our own world rests elsewhere") {
  const test::SmallFolder folder;
  REQUIRE(folder.import().ok());
  folder.write("records/libero_tasks.json", tasks_json("fill the drawer and close it"));
  write_pictures(folder, 0, 0);
  write_state(folder, 0.3);
  const auto rows_of = [&] {
    auto rows = measure_fidelity(small_options(folder));
    REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
    return std::move(rows).value();
  };
  auto rows = rows_of();
  CHECK(row_of(rows, "first pictures of a policy").held == Held::kYes);
  const FidelityRow& moved = row_of(rows, "pictures of recorded states");
  CHECK(!moved.figure.starts_with("2 pictures: 0.0 in the median"));

  fs::remove(folder.root / "records/reference/libero_90_00_state.json");
  rows = rows_of();
  CHECK(row_of(rows, "pictures of recorded states").held == Held::kNotMeasured);
  CHECK(row_of(rows, "first pictures of a policy").held == Held::kYes);

  folder.write("records/reference/libero_90_00_state.json", R"({"state_t10": [0, 1, 2]})");
  const auto damaged = measure_fidelity(small_options(folder));
  REQUIRE(!damaged.ok());
  CHECK(to_text(damaged.failure()).find("`state_t10` is no state of this task") !=
        std::string::npos);
}

TEST_CASE("fidelity of a small import: what is measured, what is beyond its bar, what is lacking") {
  const test::SmallFolder folder;
  const auto report = folder.import();
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  FidelityOptions options = small_options(folder);
  options.records.clear();
  auto rows = measure_fidelity(options);
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  CHECK(row_of(*rows, "instructions, horizons, goals, order").held == Held::kYes);
  CHECK(row_of(*rows, "instructions, horizons, goals, order").figure == "1 of 1");
  CHECK(row_of(*rows, "starts").held == Held::kYes);
  CHECK(row_of(*rows, "starts").figure.starts_with("2 of 2;"));
  for (const char* row : {"masses, centres, inertias", "torques of given states",
                          "things behind the ten waiting steps", "pictures of recorded states",
                          "first pictures of a policy"}) {
    CHECK(row_of(*rows, row).held == Held::kNotMeasured);
    CHECK(row_of(*rows, row).how == "no records: `--records DIR`");
  }

  folder.write("records/libero_tasks.json", tasks_json("fill the drawer and close it"));
  folder.write("records/libero_object_classes.json", classes_json(0.0288));
  write_settled(folder, 0.001);
  rows = measure_fidelity(small_options(folder));
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  CHECK(row_of(*rows, "instructions, horizons, goals, order").held == Held::kYes);
  const FidelityRow& masses = row_of(*rows, "masses, centres, inertias");
  CAPTURE(masses.figure);
  for (const std::string& other : masses.others) CHECK(other == "");
  CHECK(masses.held == Held::kYes);
  CHECK(row_of(*rows, "things behind the ten waiting steps").held == Held::kYes);
  CHECK(row_of(*rows, "torques of given states").how ==
        "the records have no reference/osc_unit_*.json");

  // What differs is named.
  folder.write("records/libero_tasks.json", tasks_json("put a lid in the drawer"));
  folder.write("records/libero_object_classes.json", classes_json(0.03));
  write_settled(folder, 0.003);
  rows = measure_fidelity(small_options(folder));
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  CHECK(row_of(*rows, "instructions, horizons, goals, order").others ==
        std::vector<std::string>{"libero_90_00: other words"});
  const FidelityRow& heavier = row_of(*rows, "masses, centres, inertias");
  CHECK(heavier.held == Held::kNo);
  REQUIRE(heavier.others.size() == 1);
  CHECK(heavier.others[0].starts_with("Cup: mass 0.04"));
  const FidelityRow& settled = row_of(*rows, "things behind the ten waiting steps");
  CHECK(settled.held == Held::kNo);
  CHECK(settled.figure.starts_with("50.00 % (1 of 2)"));
  REQUIRE(settled.others.size() == 1);
  CHECK(settled.others[0].starts_with("libero_90_00, start 1: cup_1 by 3.0 mm and 0.0 degrees"));

  // A start of the import that is another than the stored one.
  const fs::path table = folder.root / "out/starts/libero_90_00.csv";
  std::string text = test::text_of(table);
  text.replace(text.find("-0.07"), 5, "-0.08");
  folder.write("out/starts/libero_90_00.csv", text);
  options = small_options(folder);
  options.records.clear();
  rows = measure_fidelity(options);
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  CHECK(row_of(*rows, "starts").held == Held::kNo);
  CHECK(row_of(*rows, "starts").others == std::vector<std::string>{"libero_90_00, start 0"});
}

TEST_CASE("folders that are no import, no LIBERO and no records are refused by name") {
  const test::SmallFolder folder;
  REQUIRE(folder.import().ok());
  FidelityOptions options = small_options(folder);
  CHECK(measure_fidelity(options).failure().where.ends_with("records/libero_tasks.json"));
  const auto refused = [&](const std::string& file, const std::string& text) {
    folder.write("records/" + file, text);
    const auto rows = measure_fidelity(options);
    return rows.ok() ? std::string() : to_text(rows.failure());
  };
  const std::string tasks = "libero_tasks.json", classes = "libero_object_classes.json";
  CHECK(refused(tasks, "{\"tasks\":[{\"suite\":1") == "libero_tasks.json: this is no JSON");
  CHECK(refused(tasks, "{\"tusks\":3}") == "libero_tasks.json: there is no `tasks`");
  CHECK(refused(tasks, "{\"tasks\":[{\"suite\":1}]}") ==
        "libero_tasks.json, task 0: `suite` is not a text");
  REQUIRE(refused(tasks, tasks_json("fill the drawer and close it")).empty());
  std::string changed = tasks_json("fill the drawer and close it");
  REQUIRE(refused(classes, classes_json(0.0288)).empty());
  changed.replace(changed.find("\"close\""), 7, "\"shut\"");
  CHECK(refused(tasks, changed) == "libero_tasks.json, libero_90_00: `shut` is no rule");
  REQUIRE(refused(tasks, tasks_json("fill the drawer and close it")).empty());
  changed = classes_json(0.0288);
  changed.replace(changed.find("\"0 0 0.1\""), 9, "\"0 0 a.1\"");
  CHECK(refused(classes, changed) ==
        "libero_object_classes.json, Chest: `pos` has what is no number");
  CHECK(refused(classes, "{}") == "libero_object_classes.json: there is no `Cup`");
  std::string text = classes_json(0.0288);
  text.replace(text.find("\"ipos\":[0,0,"), 12, "\"ipos\":[0,");
  CHECK(refused(classes, text) == "libero_object_classes.json, Cup: `ipos` has 2 numbers, not 3");
  REQUIRE(refused(classes, classes_json(0.0288)).empty());
  CHECK(refused("libero_settled.npz", test::stored_zip("libero_90_00.npy", test::npy({{1, 2}})))
            .find("its rows are no states of this task") != std::string::npos);
  // Rows of the state alone, without the fixture's joint.
  CHECK(refused("libero_settled.npz",
                test::stored_zip("libero_90_00.npy", test::npy({std::vector<double>(31, 1.0)}))) ==
        "libero_settled.npz: libero_90_00: its rows are no states of this task");
  std::string whole = test::npy({std::vector<double>(32, 1.0)});
  for (const char* dtype : {"<i8", ">f8", "<f4"}) {
    std::string other = whole;
    other.replace(other.find("<f8"), 3, dtype);
    if (std::string_view(dtype) == "<f4") other.resize(other.size() - 32 * 4);
    const std::string said =
        refused("libero_settled.npz", test::stored_zip("libero_90_00.npy", other));
    CAPTURE(said);
    CHECK(said.starts_with("libero_settled.npz: libero_90_00: "));
    CHECK(said.find(fmt::format("`{}`", dtype)) != std::string::npos);
  }
  CHECK(refused("libero_settled.npz",
                test::stored_zip("libero_90_00.npy",
                                 test::npy({std::vector<double>(32, 1.0),
                                            std::vector<double>(32, std::nan(""))}))) ==
        "libero_settled.npz: libero_90_00: start 1 has what is no number");
  std::string damaged = test::stored_zip("libero_90_00.npy", whole);
  damaged[damaged.find("<f8") + 200] ^= 1;
  CHECK(refused("libero_settled.npz", damaged)
            .find("is not what it was when it was packed: another checksum") != std::string::npos);
  CHECK(refused("libero_settled.npz", "PK").find("no zip archive") != std::string::npos);
  CHECK(refused("libero_settled.npz", test::stored_zip("libero_90_00.npy", "no array"))
            .starts_with("libero_settled.npz: libero_90_00: a .npy array"));
  fs::remove(folder.root / "records/libero_settled.npz");
  folder.write("records/reference/libero_90_00_osc.csv", "step,a0\n1,2,3\n");
  CHECK(refused("reference/osc_unit_libero_90_00.json", "[{\"J\":[1]}]") ==
        "reference/osc_unit_libero_90_00.json: there is no `q`");
  CHECK(refused("reference/osc_unit_libero_90_00.json", "[]") ==
        "reference/libero_90_00_osc.csv:2: expected 2 cells, found 3");
  for (const char* number : {"nan", "inf", "-inf"}) {
    CHECK(refused("reference/libero_90_00_osc.csv", fmt::format("step,a0\n1,{}\n", number)) ==
          fmt::format("reference/libero_90_00_osc.csv:2: expected a number, found `{}`", number));
  }
  options.records.clear();
  options.original = (folder.root / "assets").string();
  CHECK(measure_fidelity(options).failure().message ==
        "no LIBERO folder: there is no `bddl_files`");
  options.original = folder.root.string();
  folder.write("other/libero_goal.probe", "");
  options.import = (folder.root / "other").string();
  const auto elsewhere = measure_fidelity(options);
  REQUIRE(elsewhere.ok());
  CHECK(row_of(*elsewhere, "starts").others ==
        std::vector<std::string>{"libero_90_00: is not in the import"});
}

TEST_CASE("where nothing was compared nothing is held and nothing is missed") {
  const test::SmallFolder folder;
  REQUIRE(folder.import().ok());
  folder.write("records/libero_tasks.json", tasks_json("fill the drawer and close it"));
  folder.write("records/reference/osc_unit_libero_90_00.json", "[]");
  folder.write("records/reference/libero_90_00_osc.csv",
               "step,a0,a1,a2,a3,a4,a5,a6,q1,q2,q3,q4,q5,q6,q7,f1,f2,tcp_x,tcp_y,tcp_z\n");
  const auto rows = measure_fidelity(small_options(folder));
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  for (const char* what : {"torques of given states", "arm over the recorded steps",
                           "fingers, closing freely", "drawers, doors and knobs"}) {
    CAPTURE(what);
    CHECK(row_of(*rows, what).held == Held::kNotMeasured);
    CHECK(row_of(*rows, what).figure == "");
  }
}

TEST_CASE("the starts of a task that is not in the import are missed") {
  const test::SmallFolder folder;
  REQUIRE(folder.import().ok());
  const std::string other = "KITCHEN_SCENE1_put_a_lid_in_the_drawer";
  for (const auto& [of, ending] :
       {std::pair{"bddl_files", ".bddl"}, {"init_files", ".pruned_init"}}) {
    const fs::path in = folder.root / of / "libero_90";
    fs::copy_file(in / (std::string(test::kSmallTask) + ending), in / (other + ending));
  }
  FidelityOptions options = small_options(folder);
  options.records.clear();
  const auto rows = measure_fidelity(options);
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  const FidelityRow& starts = row_of(*rows, "starts");
  CHECK(starts.held == Held::kNo);
  CHECK(starts.figure.ends_with("; 1 task not imported"));
  REQUIRE(starts.others.size() == 1);
  CHECK(starts.others[0].ends_with(": is not in the import"));
}

TEST_CASE(
    "an import that has none of the recorded tasks is refused, and lacks the folder's by name") {
  const test::SmallFolder folder;
  REQUIRE(folder.import().ok());
  folder.write("records/libero_tasks.json", tasks_json("fill the drawer and close it"));
  folder.write("records/libero_object_classes.json", classes_json(0.0288));
  FidelityOptions options = small_options(folder);
  // A suite of which no task was imported has no text.
  fs::remove(folder.root / "out/libero_90.probe");
  folder.write("out/libero_goal.probe", "");
  const auto none = measure_fidelity(options);
  REQUIRE_FALSE(none.ok());
  CHECK(none.failure().message == "the import has none of the recorded tasks");
  options.records.clear();
  const auto rows = measure_fidelity(options);
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  CHECK(row_of(*rows, "instructions, horizons, goals, order").held == Held::kNo);
  CHECK(row_of(*rows, "instructions, horizons, goals, order").others ==
        std::vector<std::string>{"libero_90_00: is not in the import"});
}

TEST_CASE("a deviation that is no number is worse than any") {
  const double none = std::nan("");
  for (const double found : {worse(1, none), worse(none, 1), worse(worse(0, none), 5)})
    CHECK_FALSE(found <= 1e300);
  CHECK(worse(1, 2) == 2);
  CHECK(worse(2, 1) == 2);
}

TEST_CASE("fidelity of the reference's import, fixtures where the records have them") {
  if (!test::has_reference()) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  const auto records = Records::open(test::reference());
  REQUIRE_MESSAGE(records.ok(), (records.ok() ? "" : to_text(records.failure())));
  const fs::path poses =
      fs::temp_directory_path() / fmt::format("vlaprobe_libero_poses_{}.csv", getpid());
  std::string text = "suite,task,fixture,x_m,y_m,z_m,qw,qx,qy,qz\n";
  for (const RecordedTask& task : records->tasks()) {
    for (const auto& [name, fixture] : task.said["fixtures"].items()) {
      text += task.suite + "," + task.stem + "," + name;
      for (const char* part : {"pos", "quat"}) {
        for (const Json& number : fixture["pose_at_seed7"][part])
          text += fmt::format(",{}", number.get<double>());
      }
      text += "\n";
    }
  }
  std::ofstream(poses) << text;
  const fs::path to = test::imported_reference("fidelity", poses.string());
  fs::remove(poses);
  FidelityOptions options;
  options.import = to.string();
  options.original = options.records = test::reference();
  const auto rows = measure_fidelity(options);
  fs::remove_all(to);
  REQUIRE_MESSAGE(rows.ok(), (rows.ok() ? "" : to_text(rows.failure())));
  for (const FidelityRow& row : *rows) {
    MESSAGE(row.what << ": " << row.figure << " (bar " << row.bar << "): " << to_text(row.held));
    CAPTURE(row.what);
    for (const std::string& other : row.others) CAPTURE(other);
    CHECK(row.held != Held::kNotMeasured);
    if (row.what == "first pictures of a policy") {
      // Two packs of butter that are stored in one another part otherwise.
      for (const std::string& other : row.others)
        CHECK_MESSAGE(other.starts_with("libero_90_00 "), other);
      continue;
    }
    CHECK(row.held == Held::kYes);
  }
  const FidelityRow& settled = row_of(*rows, "things behind the ten waiting steps");
  CHECK(settled.others.size() <= 85);
}

}  // namespace probe::libero
