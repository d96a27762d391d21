// Searches for spots that are known, whole: text, space, points, expert, episodes, findings.
#include "runtime/search/search.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/base/sha256.h"
#include "runtime/search/merge_searches.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "tests/compiler/space/space_text.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/servers/python_server.h"

namespace probe::search {
namespace {

struct Search {
  std::unique_ptr<space::SpaceText> text;
  SearchOptions options;
  std::string said;

  // `body`: the space of carrot_on_plate.
  Search(Method method, const std::string& body, const std::string& policy)
      : text(space::space_text("space around of carrot_on_plate {\n" + body + "\n}\n")) {
    options.method = method;
    options.text = {text->file, "", VLAPROBE_SOURCE_DIR "/assets", VLAPROBE_SOURCE_DIR "/dsl"};
    options.run.policy = policy;
    options.run.out = text->folder / "search";
    options.run.jobs = 2;
    options.levels = 11;
    options.error = 0.1;
  }

  SearchSummary find() {
    auto found = search::search(options, said);
    INFO(said);
    REQUIRE_MESSAGE(found.ok(), to_text(found.failure()));
    return std::move(found).value();
  }
  Failure refused() {
    const auto found = search::search(options, said);
    REQUIRE_FALSE(found.ok());
    return found.failure();
  }
};

TEST_CASE(
    "a boundary is found where it is, the text of it compiles, and the same call runs nothing") {
  Search search(Method::kBoundary, "light ambient 0.05 .. 0.6", "weak:ambient<0.17");
  const SearchSummary found = search.find();
  REQUIRE(found.lines.size() == 2);
  CAPTURE(found.lines[0]);
  const Json& down = found.findings.at("axes")[0];
  CHECK(down.value("status", "") == "found");
  // Levels of 0.025: 0.175 succeeds, 0.15 fails.
  CHECK(down.at("tolerance").get<double>() > 0.14);
  CHECK(down.at("tolerance").get<double>() < 0.185);
  CHECK(found.findings.at("axes")[1].value("status", "") == "no fall");
  CHECK(found.is_done);
  const std::string kept = search.options.run.out + "/found.probe";
  REQUIRE(is_file(kept));
  const AnalyzedText text = space::analyzed(kept);
  CHECK(text.compilation.diagnostics.items().empty());

  const SearchSummary again = search.find();
  CHECK(again.ran == 0);
  CHECK(again.findings == found.findings);
  const auto shown = read_search(search.options.run.out);
  REQUIRE(shown.ok());
  CHECK(shown->lines == found.lines);
}

TEST_CASE("a folder that was begun with another policy, text or seed is refused by name") {
  Search search(Method::kBoundary, "light ambient 0.2 .. 0.4", "null");
  const SearchSummary found = search.find();
  // It never succeeds, and so there is nothing to fall from.
  for (const Json& axis : found.findings.at("axes")) {
    CHECK(axis.value("status", "") == "fails unchanged");
    CHECK(axis.value("sentence", "").find("nothing to fall from: 0 of") != std::string::npos);
  }
  search.options.run.policy = "reach";
  CHECK(search.refused().message.find("another policy (\"null\", now \"reach\")") !=
        std::string::npos);
  search.options.run.policy = "null";
  search.options.seed = 1;
  CHECK(search.refused().message.find("another seed (0, now 1)") != std::string::npos);
  search.options.seed = 0;
  std::ofstream(search.text->file, std::ios::app) << "# more\n";
  CHECK(search.refused().message.find("the text has changed") != std::string::npos);
}

TEST_CASE("a folder that is no search's is left alone, and so is one of another format") {
  Search search(Method::kBoundary, "light ambient 0.2 .. 0.4", "null");
  std::filesystem::create_directories(search.options.run.out);
  std::ofstream(search.options.run.out + "/notes.txt") << "mine";
  CHECK(search.refused().message.find("is no search's") != std::string::npos);
  std::ofstream(search.options.run.out + "/search.json")
      << R"({"format": "vlaprobe search", "version": 99})";
  CHECK(search.refused().message.find("another version") != std::string::npos);
  std::ofstream(search.options.run.out + "/search.json")
      << R"({"format": "vlaprobe search", "version": 1})";
  CHECK(search.refused().message.find("does not say what was asked") != std::string::npos);
  std::ofstream(search.options.run.out + "/search.json") << "[1, 2";
  CHECK(search.refused().message.find("not what a search wrote") != std::string::npos);
}

TEST_CASE("a search writes into no folder of a run, and behind no link of its own folder") {
  const run::TemporaryFolder folder;
  const auto refusal = [&] {
    const Status status = check_search_folder(folder.path);
    return status.ok() ? "" : to_text(status.failure());
  };
  CHECK(refusal().empty());
  std::filesystem::create_directories(folder / "rounds/001");
  std::filesystem::create_directories(folder / "other");
  std::ofstream(folder / "other/mine") << "mine";
  for (const char* const link : {"rounds/001/points.csv", "rounds/001/policy", "rounds/002"}) {
    CAPTURE(link);
    std::filesystem::create_symlink(folder / "other", folder / link);
    CHECK(refusal().starts_with(folder / link + ": is a link"));
    std::filesystem::remove(folder / link);
  }
  std::filesystem::create_symlink(folder / "other/mine", folder / "search.json");
  CHECK(write_search(folder.path, {{"format", "vlaprobe search"}}).ok());
  CHECK(read_file(folder / "other/mine").value() == "mine");
  CHECK(is_search(folder.path));
  std::ofstream(folder / "results.sqlite") << "";
  CHECK(refusal() == folder.path + ": holds a run; take another folder for a search");
}

TEST_CASE(
    "points that the compiler refuses are left out with its reason, those before them searched") {
  // Far from where it lies, the carrot is off the table or under the plate.
  Search search(Method::kBoundary, "place source in disc 60cm", "expert");
  search.options.levels = 7;
  const SearchSummary found = search.find();
  const Json& axis = found.findings.at("axes")[0];
  CAPTURE(axis.dump(1));
  CHECK(axis.at("last_fair").get<double>() < 60);
  CHECK(axis.value("sentence", "").find("nothing beyond") != std::string::npos);
  CHECK(axis.value("sentence", "").find("P05") != std::string::npos);
}

TEST_CASE("what a case needs to fail is found exactly, and each set that was tried is told") {
  Search search(Method::kMinimal,
                "light power 0.5 .. 2\nclutter 0 .. 3 from (nut, rabbit)\nwords phrases of source",
                "weak:clutter>=2+reworded");
  search.options.at = "light.power 0.7, clutter 3, phrase.source by_color";
  const SearchSummary found = search.find();
  CAPTURE(found.findings.dump(1));
  const Json& smallest = found.findings.at("smallest");
  CHECK(smallest.size() == 2);
  CHECK(smallest.contains("clutter"));
  CHECK(smallest.contains("phrase.source"));
  CHECK(found.findings.at("tried").size() >= 4);
}

TEST_CASE(
    "worst cases are confirmed, shrunk from their folder, and known again without compiling") {
  Search search(Method::kWorst, "clutter 0 .. 3 from (nut, rabbit)\nlight power 0.5 .. 2",
                "weak:clutter>=2");
  search.options.proves = false;
  search.options.budget = 540;
  const SearchSummary found = search.find();
  CAPTURE(found.lines);
  const Json& cases = found.findings.at("cases");
  REQUIRE(cases.size() > 0);
  CHECK(cases[0].at("confirmed").get<bool>());
  CHECK(cases[0].at("changes").at("clutter").get<double>() == 2);
  const std::string folder = search.options.run.out;

  // Unless what is stored is damaged nothing is compiled again.
  const std::string text = folder + "/rounds/001/points.probe";
  std::filesystem::remove(text);
  SearchSummary again = search.find();
  CHECK(again.ran == 0);
  CHECK(again.findings == found.findings);
  CHECK_FALSE(is_there(text));
  std::ofstream(folder + "/rounds/001/points.json") << "{}";
  again = search.find();
  CHECK(again.ran == 0);
  CHECK(again.findings == found.findings);
  CHECK(is_there(text));
  // As many starts as nothing has.
  std::string points = read_file(folder + "/rounds/001/points.json").value();
  points.insert(points.find("\"starts\":[") + 10, "0,0,0,");
  std::ofstream(folder + "/rounds/001/points.json") << points;
  std::filesystem::remove(text);
  CHECK(search.find().findings == found.findings);
  CHECK(is_there(text));
  std::filesystem::remove(text);
  std::filesystem::resize_file(folder + "/rounds/001/points.plan", 1000);
  CHECK(search.find().findings == found.findings);
  CHECK(is_there(text));

  search.options.method = Method::kMinimal;
  search.options.from = folder;
  search.options.run.out = folder + "_why";
  search.options.budget.reset();
  const SearchSummary why = search.find();
  CAPTURE(why.lines);
  CHECK(why.findings.at("smallest").size() == 1);
  CHECK(why.findings.at("smallest").contains("clutter"));
}

TEST_CASE("a damaged search.json is refused with what it lacks") {
  Search search(Method::kMinimal, "light power 0.5 .. 2", "null");
  search.options.from = search.text->folder / "from";
  std::filesystem::create_directories(search.options.from);
  const auto says = [&](const std::string& asked, const char* what) {
    std::ofstream(search.options.from + "/search.json")
        << R"({"format":"vlaprobe search","version":1,"asked":)" + asked + R"(,"cases":[{}]})";
    CAPTURE(asked);
    CHECK_MESSAGE(search.refused().message.find(what) != std::string::npos,
                  to_text(search.refused()));
  };
  says("{}", "`asked.method`");
  says(R"({"method":"worst","task":"carrot_on_plate","space":"around","text_sha256":7})",
       "`asked.text_sha256`");
  std::string said;
  const auto base = BaseTask::open(search.options.text, said);
  REQUIRE(base.ok());
  says(R"({"method":"worst","task":"carrot_on_plate","space":"around","text_sha256":")" +
           (*base)->hash() + "\"}",
       "does not say what it changes");
}

TEST_CASE("a point that is asked for by hand is one of the space, or refused with what it has") {
  Search search(Method::kMinimal, "light power 0.5 .. 2\nwords templates of put", "expert");
  const auto says = [&](const char* at, const char* what) {
    search.options.at = at;
    const Failure failure = search.refused();
    CAPTURE(failure.message);
    CHECK(failure.message.find(what) != std::string::npos);
  };
  says("light.pover 1", "did you mean `light.power`");
  says("light.power 9", "goes from x 0.5 to x 2");
  says("light.power bright", "expected a number");
  says("words shout", "is one of");
  says("light.power 1", "changes nothing");
  search.options.at = "";
  CHECK(search.refused().message.find("--from DIR") != std::string::npos);
}

TEST_CASE("a suite, a path and a folder of odd names are no hindrance") {
  Search search(Method::kAxes, "light ambient 0.2 .. 0.4", "null");
  std::ofstream(search.text->file, std::ios::app)
      << "suite around_points { tasks { carrot_on_plate }; seeds 0 }\n";
  const std::string odd = search.text->folder / "q\"d \xc3\xa9";
  std::filesystem::create_directories(odd);
  std::filesystem::rename(search.text->file, odd + "/points.probe");
  std::filesystem::create_directories(search.text->folder / "real/deep");
  std::filesystem::create_directory_symlink(search.text->folder / "real/deep",
                                            search.text->folder / "link");
  search.options.text.file = odd + "/points.probe";
  search.options.run.out = search.text->folder / "link/search";
  search.options.budget = 40;
  const SearchSummary found = search.find();
  REQUIRE_FALSE(found.lines.empty());
  CHECK(found.lines.back() == "all that were tried end alike, so there is nothing to compare");
  // Another budget draws other points.
  search.options.budget = 41;
  CHECK(search.refused().message.find("another budget (40, now 41)") != std::string::npos);
}

TEST_CASE("a task whose camera moves is searched over the starts that stay in its picture") {
  Search search(Method::kAxes,
                "camera third_view within (0cm, 0cm, 30cm), 20deg\nplace source in disc 12cm",
                "null");
  search.options.budget = 40;
  const SearchSummary found = search.find();
  CHECK(found.trials == 40);
}

TEST_CASE("recorded actions, and a budget that a method cannot do with, are refused") {
  Search search(Method::kWorst, "light ambient 0.2 .. 0.4", "null");
  search.options.budget = 100;
  CHECK(search.refused().message.find("takes 540 trials at least") != std::string::npos);
  search.options.method = Method::kAxes;
  search.options.budget = 39;
  CHECK(search.refused().message.find("takes 40 trials at least") != std::string::npos);
}

TEST_CASE("shards of a search that are merged tell what one call tells, and run nothing more") {
  Search search(Method::kBoundary, "light ambient 0.2 .. 0.4", "null");
  const SearchSummary whole = search.find();
  const std::string out = search.options.run.out;
  store::MergeOptions merging;
  for (const int shard : {1, 2}) {
    search.options.run.shard = shard;
    search.options.run.shards = 2;
    // Where a folder lies is no matter.
    search.options.run.out = shard == 1 ? out + "-1" : out + "-deep/er/2";
    CHECK_FALSE(search.find().is_done);
    merging.dirs.push_back(search.options.run.out);
  }
  search.options.run.shard = search.options.run.shards = 1;
  search.options.run.out = merging.out = out + "-all";
  const auto merged = merge_searches(merging);
  REQUIRE_MESSAGE(merged.ok(), to_text(merged.failure()));
  const SearchSummary again = search.find();
  CHECK(again.ran == 0);
  CHECK(again.lines == whole.lines);
  search.options.method = Method::kMinimal;
  search.options.at = "light.ambient 0.2";
  search.options.run.shards = 2;
  CHECK(search.refused().where == "--shard");
}

TEST_CASE("shards of a search for the worst are searches of their own, joined when they are done") {
  Search search(Method::kWorst, "light ambient 0.05 .. 0.6", "weak:ambient<0.17");
  search.options.proves = false;
  search.options.budget = 540;
  const std::string out = search.options.run.out;
  store::MergeOptions merging;
  std::vector<SearchSummary> found;
  for (const int shard : {1, 2}) {
    search.options.run.shard = shard;
    search.options.run.shards = 2;
    search.options.run.out = out + "-" + std::to_string(shard);
    merging.dirs.push_back(search.options.run.out);
    found.push_back(search.find());
    CHECK(found.back().is_done);
  }
  CHECK(found[0].findings.at("cases") != found[1].findings.at("cases"));
  // Another shard, none, or the joined folder are not gone on with.
  search.options.run.shard = 1;
  CHECK(search.refused().message.find("another shard (\"2/2\", now \"1/2\")") != std::string::npos);
  search.options.run.shards = 1;
  CHECK(search.refused().message.find("holds shard 2/2") != std::string::npos);
  merging.out = search.options.run.out = search.text->folder / "deep/all";
  const auto merged = merge_searches(merging);
  REQUIRE_MESSAGE(merged.ok(), to_text(merged.failure()));
  CHECK(search.refused().message.find("holds shards that were joined") != std::string::npos);
  const SearchSummary all = read_search(merging.out).value();
  CHECK(all.trials == found[0].trials + found[1].trials);
  CHECK(all.lines.size() == all.findings.at("cases").size());
  CHECK(all.findings.at("own_failures")[1].get<int>() == 120);
  CHECK(is_there(merging.out + "/rounds/2-001/points.csv"));
  const std::string text = read_file(merging.out + "/found.probe").value();
  for (const Json& one : all.findings.at("cases")) {
    CHECK_MESSAGE(one.at("confirmed").get<bool>(), all.lines);
    CHECK(text.find(one.value("name", "none")) != std::string::npos);
  }
  const std::string round = read_file(merging.out + "/rounds/1-001/points.probe").value();
  CHECK(round.find("\nuse \"../../../../") != std::string::npos);
  // Its cases are taken up from there.
  search.options.method = Method::kMinimal;
  search.options.from = merging.out;
  search.options.run.out = out + "-why";
  search.options.budget.reset();
  const SearchSummary why = search.find();
  const Json* const smallest = why.findings.find("smallest");
  REQUIRE_MESSAGE(smallest != nullptr, why.lines.front());
  CHECK(smallest->contains("light.ambient"));
}

TEST_CASE(
    "a server that dies in the middle ends the search, and the same call goes on from there") {
  Search search(Method::kBoundary, "sensor noise 0 .. 0.1", "");
  std::vector<std::string> words = {"openpi", "seen=fine"};
  auto server = std::make_unique<test::PythonServer>("openpi_server.py", words);
  REQUIRE_MESSAGE(!server->port().empty(), "Debian's python3-websockets is installed");
  const std::string port = server->port();
  words.push_back("port=" + port);
  search.options.proves = false;
  search.options.run.policy =
      "openpi://127.0.0.1:" + port +
      "?action.form=delta&action.units=m_rad&action.rotation=vector&chunk.length=any&chunk.use=all"
      "&timeout.wait_s=0.05";
  search.options.run.name = "mine";
  search.options.run.retries = 0;
  search.options.run.give_up_after = 1;
  search.options.run.progress = [&](const run::RunProgress& progress) {
    if (progress.done == 3) server.reset();
  };
  const Failure failure = search.refused();
  CHECK_MESSAGE(failure.code == Fault::kPolicy, to_text(failure));
  // Without a server nothing goes on, and nothing is lost.
  search.options.run.progress = nullptr;
  CHECK(search.refused().code == Fault::kPolicy);
  server = std::make_unique<test::PythonServer>("openpi_server.py", words);
  const SearchSummary mended = search.find();
  CHECK(mended.is_done);
  CHECK(mended.ran > 0);
  CHECK(mended.ran <= mended.episodes - 2);
  search.options.run.out += "_whole";
  const SearchSummary whole = search.find();
  CHECK(mended.findings.at("axes") == whole.findings.at("axes"));
  CHECK(mended.lines == whole.lines);
}

// It asks for a step of two metres, which nobody can do, whenever it sees one of some pictures or
// wherever it is asked; not where a server is looked at before.
class Wild final : public servers::ServedPolicy {
 public:
  enum class When : std::uint8_t { kSomePictures, kAlways };
  explicit Wild(When when) : when_(when) {}
  void reset() override {}
  Result<std::vector<policy::Action>> answer(const servers::Asked& asked, int count) override {
    auto actions = digest_->answer(asked, count);
    const Sha256 hash = sha256(std::as_bytes(std::span(asked.picture.bytes)));
    const bool is_one = when_ == When::kAlways || (hash.bytes[0] == 0 && hash.bytes[1] < 64);
    if (actions && is_one && !servers::is_known_observation(asked.picture.bytes, asked.words))
      actions->front()[0] = 2;
    return actions;
  }

 private:
  When when_;
  std::unique_ptr<servers::ServedPolicy> digest_ = servers::serve_digest().value()();
};

// A server of it that the search asks from now on, as long as what is returned is there.
std::unique_ptr<wire::Listener> serve_wild(Search& search, Wild::When when) {
  servers::ServeOptions served;
  served.policy = [when] { return std::make_unique<Wild>(when); };
  auto listener = servers::serve(servers::Protocol::kOpenpi, served);
  REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
  search.options.proves = false;
  search.options.run.policy = servers::address_of_served(servers::Protocol::kOpenpi, served,
                                                         "127.0.0.1:" + (*listener)->port());
  search.options.run.name = "wild";
  search.options.run.retries = 0;
  search.options.run.give_up_after = 0;
  return std::move(listener).value();
}

TEST_CASE("what a policy asks for in some episodes and nobody can do leaves these out, each time") {
  Search search(Method::kBoundary, "sensor noise 0 .. 0.1", "");
  const auto server = serve_wild(search, Wild::When::kSomePictures);
  const SearchSummary found = search.find();
  CHECK(found.left_out > 0);
  CHECK(found.invalid > 0);
  CHECK_MESSAGE(found.lines[0].find("trials are invalid and left out, first") != std::string::npos,
                found.lines[0]);
  CHECK(found.lines[0].find("2.0") != std::string::npos);
  const SearchSummary again = search.find();
  CHECK(again.findings == found.findings);
}

TEST_CASE(
    "of a policy that spoils what it is asked for nothing is said, least of all what is fair") {
  Search search(Method::kBoundary, "sensor noise 0 .. 0.1", "");
  const auto server = serve_wild(search, Wild::When::kAlways);
  const Failure failure = search.refused();
  CHECK(failure.code == Fault::kPolicy);
  CHECK_MESSAGE(failure.message.find("Of such a policy nothing is said") != std::string::npos,
                failure.message);
  CHECK_FALSE(read_search(search.options.run.out)->is_done);
}

TEST_CASE("a text without a space, with several, or with mistakes is refused") {
  Search search(Method::kBoundary, "light ambient 0.2 .. 0.4", "null");
  search.options.text.space = "arund";
  CHECK(search.refused().message.find("did you mean `around`") != std::string::npos);
  search.options.text.space = "";
  std::ofstream(search.text->file, std::ios::app)
      << "space other of carrot_on_plate { light ambient 0.2 .. 0.4 }\n";
  CHECK(search.refused().message.find("around, other") != std::string::npos);
  std::ofstream(search.text->file, std::ios::app) << "space other of nobody { }\n";
  CHECK(search.refused().message.find("has mistakes") != std::string::npos);
  CHECK(search.said.find("nobody") != std::string::npos);
  std::ofstream(search.text->file) << "use \"suite/intact.probe\"\n";
  CHECK(search.refused().message.find("declares no space") != std::string::npos);
  search.options.text.file = "suite.plan";
  CHECK(search.refused().message.find("a plan is frozen") != std::string::npos);
}

}  // namespace
}  // namespace probe::search
