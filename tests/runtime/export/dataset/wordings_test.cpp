// Which words a demonstration is told in.
#include "runtime/export/dataset/wordings.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "tests/runtime/run/temporary_folder.h"

namespace probe::dataset {
namespace {

std::string line(const std::string& wording, const std::string& split, double probability) {
  return R"({"task":"t","original":"put it","wording":")" + wording + R"(","split":")" + split +
         R"(","probability":)" + std::to_string(probability) +
         R"(,"original_probability":0.5,"starts_sha256":"aa"})" + "\n";
}

TEST_CASE("wordings are drawn by their probabilities, none twice, none held out") {
  const run::TemporaryFolder folder;
  std::ofstream(folder / "w.jsonl")
      << line("place it", "train", 0.4) << line("lay it", "train", 0.1)
      << line("drop it", "held_out", 0.0);
  const auto wordings = Wordings::read(folder / "w.jsonl");
  REQUIRE_MESSAGE(wordings.ok(), (wordings.ok() ? "" : to_text(wordings.failure())));
  CHECK(wordings->has({"t", "put it", "aa"}));
  CHECK(!wordings->has({"t", "put that", "aa"}));
  std::map<std::string, int> counts;
  for (int i = 0; i < 2000; ++i)
    ++counts[wordings->draw({"t", "put it", "aa"}, 1, std::to_string(i))[0]];
  CHECK(counts["put it"] == doctest::Approx(1000).epsilon(0.1));
  CHECK(counts["place it"] == doctest::Approx(800).epsilon(0.1));
  CHECK(counts["lay it"] == doctest::Approx(200).epsilon(0.25));
  CHECK(counts.size() == 3);
  const auto all = wordings->draw({"t", "put it", "aa"}, 9, "k");
  CHECK(std::set<std::string>(all.begin(), all.end()) ==
        std::set<std::string>{"put it", "place it", "lay it"});
  CHECK(all.size() == 3);
  CHECK(wordings->draw({"t", "put it", "aa"}, 2, "k") == std::vector<std::string>{all[0], all[1]});
  CHECK(wordings->draw({"u", "put it", "aa"}, 2, "k") == std::vector<std::string>{"put it"});
  // Where other things lie around it nothing is proved.
  CHECK(!wordings->has({"t", "put it", "bb"}));
  CHECK(wordings->has_for_other_starts({"t", "put it", "bb"}));
  CHECK(!wordings->has_for_other_starts({"t", "put it", "aa"}));
  CHECK(!wordings->has_for_other_starts({"t", "put that", "bb"}));
  CHECK(wordings->draw({"t", "put it", "bb"}, 2, "k") == std::vector<std::string>{"put it"});
}

TEST_CASE("a table that is none is refused with its line") {
  const run::TemporaryFolder folder;
  std::ofstream(folder / "w.jsonl") << line("place it", "train", 0.4) << "{\"task\": 3}\n";
  CHECK(Wordings::read(folder / "w.jsonl").failure().where == folder / "w.jsonl:2");
  std::string altered = line("place it", "train", 0.4);
  altered.insert(altered.rfind('}'), R"(,"wording_sha256":"00")");
  std::ofstream(folder / "x.jsonl") << altered;
  CHECK(Wordings::read(folder / "x.jsonl").failure().message.find("is not what was proved") !=
        std::string::npos);
  std::string older = line("place it", "train", 0.4);
  older.erase(older.find(",\"starts_sha256\""), 21);
  std::ofstream(folder / "u.jsonl") << older;
  CHECK(Wordings::read(folder / "u.jsonl").failure().message.find("an older program") !=
        std::string::npos);
  std::ofstream(folder / "v.jsonl") << line("place it", "held_out", 0.4);
  CHECK(!Wordings::read(folder / "v.jsonl").ok());
  CHECK(!Wordings::read(folder / "absent.jsonl").ok());
}

}  // namespace
}  // namespace probe::dataset
