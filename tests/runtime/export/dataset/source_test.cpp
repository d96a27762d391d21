// Which episodes of which runs go into a dataset.
#include <algorithm>

#include "runtime/export/dataset/check.h"
#include "runtime/store/folder_lock.h"
#include "tests/runtime/export/dataset/exported_run.h"

namespace probe::dataset {
namespace {

bool is_told(const std::vector<std::string>& sentences, const std::string& words) {
  return std::ranges::any_of(sentences, [&](const std::string& sentence) {
    return sentence.find(words) != std::string::npos;
  });
}

plan::Plan delayed_table() {
  run::TablePlan table(std::string(VLAPROBE_SOURCE_DIR) + "/assets");
  auto bytes =
      table.write(kEpisodes, kHorizon, [](plan::Records& records) { records.tasks[0].delay = 2; });
  REQUIRE_MESSAGE(bytes.ok(), (bytes.ok() ? "" : to_text(bytes.failure())));
  return plan::Plan::from_bytes(std::move(*bytes)).value();
}

TEST_CASE("episodes whose actions do not answer their pictures are left out with the reason") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "waits");
  run::RunOptions options = run::options_for(folder / "live", "random");
  options.seeds = {42};
  options.live = policy::LiveTerms{0.4, 1};
  run::must_run(small_table(), options);
  make_run(delayed_table(), folder / "delayed");

  for (const char* name : {"live", "delayed"}) {
    const auto alone =
        export_dataset({folder / name}, folder / "alone", Format::kRobomimic, dataset_options());
    REQUIRE(!alone.ok());
    CHECK(alone.failure().code == Fault::kUsage);
    CHECK(!std::filesystem::exists(folder / "alone"));
  }
  const auto mixed = export_dataset({folder / "waits", folder / "live"}, folder / "mixed",
                                    Format::kRobomimic, dataset_options());
  REQUIRE_MESSAGE(mixed.ok(), (mixed.ok() ? "" : to_text(mixed.failure())));
  CHECK(mixed->demonstrations == kEpisodes);
  CHECK(is_told(mixed->left_out, "4 episodes of `" + (folder / "live") +
                                     "`: its world did not wait for its policy (live, 400 ms"));
  CHECK(text_of(folder / "mixed/README.md").find("did not wait") != std::string::npos);
  DatasetOptions second = dataset_options();
  second.width = 96;
  second.height = 64;
  const auto late = export_dataset({folder / "waits", folder / "delayed"}, folder / "late",
                                   Format::kRobomimic, second);
  REQUIRE_MESSAGE(late.ok(), (late.ok() ? "" : to_text(late.failure())));
  CHECK(late->demonstrations == kEpisodes);
  CHECK(is_told(late->left_out, "an action acts 2 control steps after its picture"));
}

TEST_CASE("a run that is being written says that more may come") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  {
    const auto writing = store::FolderLock::take(folder / "run");
    REQUIRE(writing.ok());
    const auto done =
        export_dataset({folder / "run"}, folder / "a", Format::kRobomimic, dataset_options());
    REQUIRE_MESSAGE(done.ok(), (done.ok() ? "" : to_text(done.failure())));
    CHECK(is_told(done->left_out, "it is being written now"));
  }
  CHECK(must_export(folder / "run", folder / "b", Format::kRobomimic, dataset_options())
            .left_out.empty());
}

// Of a task whose camera is called as its robot is.
plan::Plan renamed_table() {
  run::TablePlan table(std::string(VLAPROBE_SOURCE_DIR) + "/assets");
  auto bytes = table.write(kEpisodes, kHorizon, [](plan::Records& records) {
    for (plan::CameraRecord& camera : records.cameras) camera.name = records.robots[0].name;
  });
  REQUIRE_MESSAGE(bytes.ok(), (bytes.ok() ? "" : to_text(bytes.failure())));
  return plan::Plan::from_bytes(std::move(*bytes)).value();
}

TEST_CASE("cameras that tasks call otherwise are one in a dataset where they get one name") {
  const run::TemporaryFolder folder;
  const plan::Plan other = renamed_table();
  const std::string view(other.text(other.views(other.tasks()[0])[0].name));
  make_run(small_table(), folder / "a");
  make_run(other, folder / "b");
  const std::vector<std::string> runs = {folder / "a", folder / "b"};
  DatasetOptions options = dataset_options();
  options.width = 96;
  options.height = 64;
  const auto apart = export_dataset(runs, folder / "set", Format::kRobomimic, options);
  REQUIRE(!apart.ok());
  CHECK(apart.failure().message.find("--camera NAME=A,B") != std::string::npos);
  options.cameras = {"image=third_view," + view};
  for (const Format format : {Format::kLerobot, Format::kRobomimic, Format::kRlds}) {
    const std::string out = folder / std::to_string(static_cast<int>(format));
    const auto done = export_dataset(runs, out, format, options);
    REQUIRE_MESSAGE(done.ok(), (done.ok() ? "" : to_text(done.failure())));
    CHECK(done->demonstrations == 2 * kEpisodes);
    const auto checked = check_dataset(out);
    REQUIRE_MESSAGE(checked.ok(), (checked.ok() ? "" : to_text(checked.failure())));
    for (const std::string& problem : checked->problems) CHECK_MESSAGE(problem.empty(), problem);
  }
  CHECK(text_of(folder / "0/meta/info.json").find("observation.images.image\"") !=
        std::string::npos);
  options.cameras = {"image=third_view,", "="};
  CHECK(export_dataset(runs, folder / "set", Format::kRlds, options).failure().where == "--camera");
  options.cameras = {"image=wrist,side"};
  CHECK(export_dataset(runs, folder / "set", Format::kRlds, options)
            .failure()
            .message.find("has no camera `image=wrist,side`, but `third_view`") !=
        std::string::npos);
}

TEST_CASE("a run goes into a dataset once, by whatever name, and so does each trace") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  const std::string same = folder / "run/../run";
  for (const std::string& again : {folder / "run", same}) {
    const auto twice = export_dataset({folder / "run", again}, folder / "out", Format::kRobomimic,
                                      dataset_options());
    REQUIRE(!twice.ok());
    CHECK(twice.failure().code == Fault::kUsage);
    CHECK(twice.failure().where == again);
    CHECK(!std::filesystem::exists(folder / "out"));
  }
  std::filesystem::copy(folder / "run", folder / "copy", std::filesystem::copy_options::recursive);
  const auto once = export_dataset({folder / "run", folder / "copy"}, folder / "out",
                                   Format::kRobomimic, dataset_options());
  REQUIRE_MESSAGE(once.ok(), (once.ok() ? "" : to_text(once.failure())));
  CHECK(once->demonstrations == kEpisodes);
  CHECK(is_told(once->left_out, "4 episodes of `" + (folder / "copy") + "`: the same traces"));
  const auto checked = check_dataset(folder / "out");
  REQUIRE_MESSAGE(checked.ok(), (checked.ok() ? "" : to_text(checked.failure())));
  CHECK(checked->problems.empty());
}

TEST_CASE("words that are proved for other starts are told to nobody") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  make_run(small_table(48, 32), folder / "other");  // another camera: other pictures of the same
  write_wording(folder / "run", folder / "w.jsonl");
  DatasetOptions options = dataset_options();
  options.rephrase = folder / "w.jsonl";
  options.wordings = 2;
  options.width = options.height = 32;
  const auto mixed = export_dataset({folder / "run", folder / "other"}, folder / "out",
                                    Format::kRobomimic, options);
  REQUIRE_MESSAGE(mixed.ok(), (mixed.ok() ? "" : to_text(mixed.failure())));
  CHECK(mixed->demonstrations == 2 * kEpisodes);
  CHECK(mixed->episodes == 3 * kEpisodes);
  CHECK(is_told(mixed->left_out, "`carrot_on_plate` of `" + (folder / "other") +
                                     "`: those of the table are proved for other starts"));
}

TEST_CASE("a frame is a control step, so no other rate is written") {
  const run::TemporaryFolder folder;
  make_run(small_table(), folder / "run");
  DatasetOptions options = dataset_options();
  for (const int fps : {4, 6, 10}) {
    options.fps = fps;
    const auto refused =
        export_dataset({folder / "run"}, folder / "out", Format::kRobomimic, options);
    REQUIRE(!refused.ok());
    CHECK(refused.failure().where == "--fps");
    CHECK(refused.failure().message.find("5 control steps a second") != std::string::npos);
  }
  options.fps = 5;
  must_export(folder / "run", folder / "out", Format::kRobomimic, options);
}

}  // namespace
}  // namespace probe::dataset
