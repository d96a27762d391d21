// What is told after an edit is what is told of the same text by a server that never saw another:
// byte for byte, whatever was typed on the way.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/runtime/lsp/client.h"

using namespace probe;
using namespace probe::test;

namespace {

const std::string kSuite = VLAPROBE_SOURCE_DIR "/suite";

// The mistakes of each text as they were published last.
std::map<std::string, std::string> told(Editor& editor) {
  editor.server().settle();
  std::map<std::string, std::string> all;
  for (const Json& message : editor.messages()) {
    if (message.value("method", "") != "textDocument/publishDiagnostics") continue;
    const Json& params = message["params"];
    all[params["uri"].text()] = params["diagnostics"].dump();
  }
  // A server that had nothing to say of a text that is not open says nothing.
  std::erase_if(all, [](const auto& one) { return one.second == "[]"; });
  return all;
}

struct Text {
  std::string path, text;
  std::size_t cursor = 0;
};

// Of a server that is asked first now, all of them open.
std::map<std::string, std::string> told_cold(const std::vector<Text>& texts) {
  Editor editor(kSuite, std::chrono::hours(1));
  for (const Text& one : texts) editor.open(one.path, one.text);
  return told(editor);
}

// Types at texts, and asks now and then.
class Typist {
 public:
  explicit Typist(std::size_t every) : every_(every), editor_(kSuite, std::chrono::hours(1)) {}

  void open(const std::string& name) {
    const std::string path = std::string(VLAPROBE_SOURCE_DIR "/") + name;
    for (now_ = 0; now_ < texts_.size(); ++now_) {
      if (texts_[now_].path == path) return;
    }
    texts_.push_back({path, text_of_file(path)});
    editor_.open(path, now().text);
  }
  Text& now() { return texts_[now_]; }

  // Another text in place of what stands there, and the cursor behind it.
  void replace(std::size_t at, std::size_t size, const std::string& words) {
    const Json begin = place(at), end = place(at + size);
    now().text.replace(at, size, words);
    now().cursor = at + words.size();
    editor_.change(now().path, begin, end, words);
    editor_.server().settle();
    if (++edits_ % every_ == 0) compare(words);
  }

  void compare(const std::string& words) {
    CAPTURE(edits_);
    CAPTURE(words);
    CHECK(told(editor_) == told_cold(texts_));
    ++compared_;
  }
  std::size_t compared() const { return compared_; }

 private:
  Json place(std::size_t at) {
    const std::string& text = now().text;
    const std::size_t begin = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
    const auto lines =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
    return {{"line", lines}, {"character", at - begin}};
  }

  std::vector<Text> texts_;
  std::size_t now_ = 0;
  std::size_t every_, edits_ = 0, compared_ = 0;
  Editor editor_;
};

// Plays a session of tests/bench/typing.
void play(const std::string& session, Typist& typist) {
  std::istringstream lines(text_of_file(VLAPROBE_SOURCE_DIR "/tests/bench/typing/" + session));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t space = line.find(' ');
    const std::string verb = line.substr(0, space);
    const std::string rest = space == line.npos ? "" : line.substr(space + 1);
    std::string words;
    for (std::size_t i = 1; i + 1 < rest.size(); ++i) {
      const bool is_escape = rest[i] == '\\';
      if (is_escape) ++i;
      words += is_escape && rest[i] == 'n' ? '\n' : rest[i];
    }
    if (verb == "open") {
      typist.open(rest);
    } else if (verb == "go") {
      const std::size_t at = typist.now().text.find(words);
      REQUIRE_MESSAGE(at != std::string::npos, line);
      typist.now().cursor = at + words.size();
    } else if (verb == "type") {
      for (const char key : words) typist.replace(typist.now().cursor, 0, std::string(1, key));
    } else if (verb == "erase") {
      for (int i = std::stoi(rest); i > 0; --i) typist.replace(typist.now().cursor - 1, 1, "");
    }
  }
}

}  // namespace

TEST_CASE("what is told while a recorded session is typed is what a new server tells of the text") {
  Typist typist(9);
  play("intact.session", typist);
  CHECK(typist.compared() > 50);
}

TEST_CASE("the same of thousands of derived tasks") {
  Typist typist(47);
  play("beyond.session", typist);
  CHECK(typist.compared() > 8);
}

TEST_CASE("what is told after edits at random is what a new server tells of the text") {
  // ASCII alone: a byte is a character. Words that mean something, and some that do not.
  const std::vector<std::string> words = {"source carrot", "target plate; ", "}",      "{",  "\n",
                                          "towel",         "like ",          "\"",     "#",  "variant x of carrot_on_plate { ",
                                          "distractors nut", "say put_the; ", " | ",  "-",  "horizon 5 steps",
                                          "task t like on_table { source spoon; target towel }\n", "in "};
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    const auto below = [&](std::size_t most) { return static_cast<std::size_t>(random()) % most; };
    Typist typist(5);
    typist.open("suite/intact.probe");
    for (int i = 0; i < 60; ++i) {
      const std::size_t at = below(typist.now().text.size());
      const std::size_t size = std::min(below(3) == 0 ? below(30) : 0, typist.now().text.size() - at);
      const std::string was = typist.now().text.substr(at, size);
      const std::string word = words[below(words.size())];
      typist.replace(at, size, word);
      // Mostly taken back, so that there is something to tell of beside what is torn.
      if (below(4) != 0) typist.replace(at, word.size(), was);
    }
    typist.compare("the end");
  }
}

namespace {

// Where the words of a text begin, with how long they are: names, keywords, numbers with units.
std::vector<std::pair<std::size_t, std::size_t>> words_in(const std::string& text) {
  const auto is_of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  std::vector<std::pair<std::size_t, std::size_t>> words;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_of_word(text[end])) ++end;
    if (end > at) words.emplace_back(at, end - at);
    at = end + 1;
  }
  return words;
}

}  // namespace

TEST_CASE("what is remembered of tasks is what a new server finds, whatever word takes another's place") {
  // Of each text its own words, so that most of what comes about can be read: other objects, phrases,
  // layouts, lights, metrics, drawers, sets and sweeps of the same tasks.
  for (const std::string name :
       {"examples/roles.probe", "examples/spatial.probe", "examples/put_away.probe",
        "examples/in_turn.probe", "examples/worn_cell.probe", "examples/solution.probe",
        "examples/moving.probe", "suite/semantics.probe", "suite/kitchen_variants.probe"}) {
    CAPTURE(name);
    std::mt19937 random(7);
    const auto below = [&](std::size_t most) { return static_cast<std::size_t>(random()) % most; };
    Typist typist(4);
    typist.open(name);
    for (int i = 0; i < 32; ++i) {
      const std::string text = typist.now().text;
      const auto words = words_in(text);
      const auto [at, size] = words[below(words.size())];
      const auto [from, length] = words[below(words.size())];
      const std::string was = text.substr(at, size), word = text.substr(from, length);
      typist.replace(at, size, word);
      if (below(3) != 0) typist.replace(at, word.size(), was);
    }
    typist.compare("the end");
  }
}

TEST_CASE("a task's own light is an axis that its scene's is not, as it comes and goes") {
  const auto text = [](const std::string& own) {
    return "use \"intact.probe\"\nlight lit2 { ambient 0.9 }\nscene table2 like table { robot widowx at "
           "(14.7cm, 5.8cm, 87cm) yaw 180deg; light lit2 }\nvariant v of carrot_on_plate { scene table2" +
           own + " }\nsuite s trained on bridge_v2 { tasks { v }; seeds 42 }\n";
  };
  const std::string path = kSuite + "/own_light.probe", light = "; light lit2";
  Editor editor(kSuite, std::chrono::hours(1));
  editor.open(path, text(""));
  told(editor);
  const std::size_t column = std::string("variant v of carrot_on_plate { scene table2").size();
  const Json at = {{"line", 3}, {"character", column}};
  const Json end = {{"line", 3}, {"character", column + light.size()}};
  editor.change(path, at, at, light);
  const auto with = told(editor);
  CHECK(with == told_cold({{path, text(light)}}));
  editor.change(path, at, end, "");
  const auto without = told(editor);
  CHECK(without == told_cold({{path, text("")}}));
  CHECK(with != without);
}

TEST_CASE("a table of starts is remembered by what it says, whatever its name") {
  const std::string text =
      "use \"intact.probe\"\nlayout recorded { starts \"own_starts.probe\"; drop 1cm settle 0.5s "
      "}\n"
      "variant v of carrot_on_plate { layout recorded }\n"
      "suite s trained on bridge_v2 { tasks { v }; seeds 42 }\n";
  const auto starts = [](const std::string& x) {
    return "start,object,x_m,y_m,z_m,qw,qx,qy,qz\n0,source,-0.16,0.075,0.9,1,0,0,0\n0,target," + x +
           ",-0.075,0.9,1,0,0,0\n";
  };
  const std::string path = kSuite + "/own.probe", table = kSuite + "/own_starts.probe";
  Editor editor(kSuite, std::chrono::hours(1));
  editor.open(table, starts("-0.16"));
  editor.open(path, text);
  told(editor);
  const Json line = {{"line", 2}, {"character", 0}}, end = {{"line", 3}, {"character", 0}};
  const auto moved = [&](const std::string& x) {
    editor.change(table, line, end, "0,target," + x + ",-0.075,0.9,1,0,0,0\n");
    auto found = told(editor);
    found.erase(lsp::uri_of(table));  // no text of Probe
    return found;
  };
  auto cold = told_cold({{table, starts("9")}, {path, text}});
  cold.erase(lsp::uri_of(table));
  const auto far = moved("9");
  CHECK(far == cold);
  CHECK(moved("-0.16") != far);
}

TEST_CASE("a table of starts that changes on disk is read again when the editor tells of it") {
  const auto folder = std::filesystem::temp_directory_path() / ("vlaprobe_table_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string path = folder / "own.probe", table = folder / "starts.csv";
  const auto write = [&](const std::string& x) {
    std::ofstream(table) << "start,object,x_m,y_m,z_m,qw,qx,qy,qz\n0,source,-0.16,0.075,0.9,1,0,0,0\n0,target,"
                         << x << ",-0.075,0.9,1,0,0,0\n";
  };
  write("-0.16");
  Editor editor(folder, std::chrono::hours(1), Json::object(), AssetRoot(VLAPROBE_SOURCE_DIR "/assets"));
  editor.open(path, "use \"" + kSuite + "/intact.probe\"\n"
                    "layout recorded { starts \"starts.csv\"; drop 1cm settle 0.5s }\n"
                    "variant v of carrot_on_plate { layout recorded }\n"
                    "suite s trained on bridge_v2 { tasks { v }; seeds 42 }\n");
  CHECK(told(editor).empty());
  const auto tell = [&](const std::string& changed) {
    editor.tell("workspace/didChangeWatchedFiles",
                {{"changes", Json::array({Json{{"uri", lsp::uri_of(changed)}, {"type", 2}}})}});
    return told(editor);
  };
  write("9");
  CHECK(tell(folder / "other.csv").empty());
  const auto far = tell(table);
  REQUIRE(far.contains(lsp::uri_of(path)));
  CHECK(far.at(lsp::uri_of(path)).find("stands over the edge") != std::string::npos);
  std::filesystem::remove_all(folder);
}
