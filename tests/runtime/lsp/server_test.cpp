// Requests as an editor sends them.
#include "runtime/lsp/server.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "tests/runtime/lsp/client.h"

using namespace probe;
using namespace probe::test;
namespace fs = std::filesystem;

namespace {

const std::string kSuite = VLAPROBE_SOURCE_DIR "/suite";
const std::string kIntact = kSuite + "/intact.probe";

// The labels of what is suggested, the best first, at most so many.
std::string labels(const Json& list, std::size_t most) {
  std::string out;
  for (const Json& item : list["items"]) {
    if (most-- == 0) break;
    out += (out.empty() ? "" : " ") + item["label"].text();
  }
  return out;
}

bool has_label(const Json& list, const std::string& label) {
  for (const Json& item : list["items"]) {
    if (item["label"].text() == label) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("nothing is answered before `initialize`, nor asked after `shutdown`") {
  Editor editor("");
  CHECK(editor.ask("textDocument/hover", Json::object())["error"]["code"] == Json(-32002));
  CHECK(editor.ask("initialize", {{"rootUri", Json()}}).contains("capabilities"));
  CHECK(editor.ask("initialize", Json::object())["error"]["code"] == Json(-32600));
  CHECK(editor.ask("no/such", Json::object())["error"]["code"] == Json(-32601));
  CHECK(editor.ask("shutdown", Json()).is_null());
  CHECK(editor.ask("shutdown", Json())["error"]["code"] == Json(-32600));
  CHECK_FALSE(editor.server().has_ended());
  editor.tell("exit", Json());
  CHECK(editor.server().has_ended());
  CHECK(editor.server().exit_code() == 0);
}

TEST_CASE("an `exit` without `shutdown` is told by the exit code") {
  Editor editor(kSuite);
  editor.tell("exit", Json());
  CHECK(editor.server().exit_code() == 1);
}

TEST_CASE("mistakes are told while one types, and gone when they are mended") {
  Editor editor(kSuite);
  const std::string text = text_of_file(kIntact);
  editor.open(kIntact, text);
  CHECK(editor.codes(kIntact).empty());
  const Json at = place_of(text, "source carrot", 7);
  Json end = at;
  end["character"] = at["character"].get<int>() + 6;
  editor.change(kIntact, at, end, "carot");
  CHECK(editor.codes(kIntact) == "P0201");
  end["character"] = at["character"].get<int>() + 5;
  editor.change(kIntact, at, end, "carrot");
  CHECK(editor.codes(kIntact).empty());
}

TEST_CASE("what is not saved of one text counts in another") {
  Editor editor(kSuite);
  const std::string catalog = kSuite + "/catalog.probe";
  std::string text = text_of_file(catalog);
  editor.open(kIntact, text_of_file(kIntact));
  editor.open(catalog, text);
  CHECK(editor.codes(kIntact).empty());
  text.replace(text.find("object carrot"), 13, "object karrot");
  editor.change(catalog, text);
  CHECK(editor.codes(catalog).find("P0201") == 0);  // said where it is named first
  editor.tell("textDocument/didClose", Editor::document(catalog));
  CHECK(editor.codes(catalog).empty());
  CHECK(editor.codes(kIntact).empty());
}

TEST_CASE("the whole check follows: what is out of reach") {
  Editor editor(kSuite, std::chrono::milliseconds(1));
  Folder folder;
  const std::string path = folder.write("far.probe", "");
  const std::string text = "use \"" + kSuite +
                           "/intact.probe\"\n"
                           "layout far like grid_24 { place source at (4cm, 33cm) }\n"
                           "task far_carrot like carrot_on_plate { layout far }\n"
                           "suite s { tasks { far_carrot }; seeds 1 }\n";
  editor.open(path, text);
  const std::string at_once = editor.codes(path);
  const std::string whole = editor.codes(path, true);
  CAPTURE(at_once);
  CHECK(whole.find(at_once) == 0);
  // While one types on, what the whole check said stays where its text is.
  editor.change(path, "# a line more\n" + text);
  CHECK(editor.codes(path).size() == whole.size());
}

TEST_CASE("models beside a text are found, and folders that are named as well") {
  Folder folder;
  const fs::path objects = fs::path(VLAPROBE_SOURCE_DIR) / "assets/objects";
  fs::create_directories(folder.path() + "/near/objects");
  fs::create_directories(folder.path() + "/named/objects");
  fs::copy(objects / "plate", folder.path() + "/near/objects/my_plate");
  fs::copy(objects / "plate", folder.path() + "/named/objects/other_plate");
  const std::string text = "use \"" + kIntact +
                           "\"\nobject mine like plate { mesh \"my_plate\"; name \"my plate\" }\n"
                           "object other like plate { mesh \"other_plate\"; name \"other plate\" }\n"
                           "task a like on_table { source carrot; target mine }\n"
                           "task b like on_table { source carrot; target other }\n"
                           "suite s { tasks { a, b }; seeds 1 }\n";
  const std::string path = folder.write("near/my.probe", text);
  Editor unnamed(folder.path(), std::chrono::milliseconds(1));
  unnamed.open(path, text);
  CHECK(unnamed.codes(path, true).find("P0202") == unnamed.codes(path, true).rfind("P0202"));
  CHECK(unnamed.codes(path, true).find("P0202") != std::string::npos);  // the other plate
  Editor named(folder.path(), std::chrono::milliseconds(1), Json::object(),
               AssetRoot::chosen({folder.path() + "/named", VLAPROBE_SOURCE_DIR "/assets"}));
  named.open(path, text);
  CHECK(named.codes(path, true).find("P0202") == std::string::npos);
}

TEST_CASE("completion asks the grammar: kinds, words, units, clear phrases") {
  Editor editor(kSuite);
  const std::string text = text_of_file(kIntact);
  const auto complete = [&](const std::string& more, std::size_t back = 0) {
    const std::string mark = "# behind it\n", all = text + mark + more;
    editor.open(kIntact, all);
    return editor.ask(
        "textDocument/completion",
        Editor::at(kIntact, place_of(all, mark, mark.size() + more.size() - back)));
  };
  CHECK(has_label(complete("task t like "), "carrot_on_plate"));
  CHECK_FALSE(has_label(complete("task t like "), "carrot"));
  CHECK(has_label(complete("task t like on_table { source "), "carrot"));
  CHECK(has_label(complete("task t like on_table { "), "distractors"));
  CHECK(has_label(complete("ta"), "task"));
  CHECK(has_label(complete("task t like on_table { say "), "drop_on"));
  CHECK(labels(complete("layout l like grid_24 { drop 10c"), 9) == "cm m mm");
  CHECK(has_label(complete("@allow("), "confounded"));
  CHECK(has_label(complete("use \"cat\"", 1), "catalog.probe"));
  CHECK(has_label(complete("task t like on_table { say \"put {so\" }", 3), "source"));
  // In a comment nothing.
  CHECK(labels(complete("# ta"), 9).empty());
}

TEST_CASE("phrases that mean their object alone come first, others say whom they mean as well") {
  Editor editor(kSuite);
  const std::string more =
      "variant hard of carrot_on_plate { distractors orange; refer source as by_color }\n";
  const std::string text = text_of_file(kIntact) + more;
  editor.open(kIntact, text);
  const Json list = editor.ask("textDocument/completion",
                               Editor::at(kIntact, place_of(text, more, more.find("by_color"))));
  REQUIRE(list["items"].size() > 1);
  CHECK(list["items"][0]["label"].text() == "favorite");
  CHECK(list["items"][0]["detail"].text() == "\"rabbit's favorite vegetable\": `carrot` alone");
  bool is_told = false;
  for (const Json& item : list["items"]) {
    if (item["label"].text() == "by_color")
      is_told = item["detail"].text() == "\"orange object\": also `orange`";
  }
  CHECK(is_told);
}

TEST_CASE("a name is found, referred to, highlighted, and renamed in every text") {
  Folder folder;
  const std::string things =
      folder.write("things.probe", "attribute color { red, blue }\nobject ball { color red }\n");
  const std::string user = folder.write(
      "user.probe", "use \"things.probe\"\nobject other like ball { color blue }\n");
  const std::string second =
      folder.write("second.probe", "use \"things.probe\"\nobject third like ball { color blue }\n");
  Editor editor(folder.path());
  const std::string text = text_of_file(user);
  editor.open(user, text);
  const Json here = Editor::at(user, place_of(text, "ball"));
  const Json found = editor.ask("textDocument/definition", here);
  REQUIRE(found.size() == 1);
  CHECK(found[0]["uri"].text() == lsp::uri_of(things));
  Json all = here;
  all["context"] = {{"includeDeclaration", true}};
  CHECK(editor.ask("textDocument/references", all).size() == 3);
  all["context"] = {{"includeDeclaration", false}};
  CHECK(editor.ask("textDocument/references", all).size() == 2);
  CHECK(editor.ask("textDocument/documentHighlight", here).size() == 1);
  CHECK(editor.ask("textDocument/prepareRename", here)["placeholder"].text() == "ball");
  Json rename = here;
  rename["newName"] = "globe";
  const Json edit = editor.ask("textDocument/rename", rename);
  CHECK(edit["changes"].items().size() == 3);
  rename["newName"] = "other";
  CHECK(editor.ask("textDocument/rename", rename)["error"]["message"].text() ==
        "there is a object `other` already: " + user + ":2");
  rename["newName"] = "two words";
  CHECK(editor.ask("textDocument/rename", rename).contains("error"));
  CHECK(editor.ask("workspace/symbol", {{"query", "ball"}}).size() == 1);
  (void)second;
}

TEST_CASE("a rename that would change what another name stands for is refused") {
  Folder folder;
  const std::string path = folder.write("a.probe", "");
  Editor editor(folder.path());
  const std::string text =
      "role helper\n"
      "predicate near2(a: object, c: object) = distance(a, c) < 2cm and height(source) > 1m\n"
      "predicate far2(b: object) = height(helper) > 1m and height(b) > 1m\n";
  editor.open(path, text);
  const auto renamed = [&](const std::string& what, const std::string& name) {
    Json rename = Editor::at(path, place_of(text, what));
    rename["newName"] = name;
    return editor.ask("textDocument/rename", rename);
  };
  // A word of the language, a role, a parameter and a predicate, each of another kind or scope.
  for (const char* name : {"source", "target", "surface", "none", "others", "height", "task", "helper", "b",
                           "far2"}) {
    CAPTURE(name);
    CHECK(renamed("a: object", name).contains("error"));
  }
  CHECK(renamed("a: object", "helper")["error"]["message"].text() ==
        "`helper` stands for something already: " + path + ":1");
  CHECK(renamed("helper", "a").contains("error"));
  CHECK(renamed("a: object", "thing")["changes"].items().size() == 1);
}

TEST_CASE("a rename is refused where another text of the folder has the name") {
  Folder folder;
  const std::string things = folder.write("things.probe", "object foo { friction 1 }\n");
  const std::string user =
      folder.write("user.probe", "use \"things.probe\"\nobject other like foo { friction 2 }\n");
  const std::string second = folder.write(
      "d.probe", "use \"things.probe\"\nobject foo2 like foo { friction 3 }\n");
  Editor editor(folder.path());
  editor.open(user, text_of_file(user));
  Json rename = Editor::at(user, place_of(text_of_file(user), "foo"));
  rename["newName"] = "foo2";
  CHECK(editor.ask("textDocument/rename", rename)["error"]["message"].text() ==
        "there is a object `foo2` already: " + second + ":2");
  rename["newName"] = "foo3";
  CHECK(editor.ask("textDocument/rename", rename)["changes"].items().size() == 3);
}

TEST_CASE("texts that are not open are read anew for a rename, and what cannot be read refuses it") {
  Folder folder;
  folder.write("things.probe", "object foo { friction 1 }\n");
  const std::string user =
      folder.write("user.probe", "use \"things.probe\"\nobject other like foo { friction 2 }\n");
  const std::string second =
      folder.write("b.probe", "use \"things.probe\"\nobject third like foo { friction 3 }\n");
  Editor editor(folder.path());
  editor.open(user, text_of_file(user));
  Json rename = Editor::at(user, place_of(text_of_file(user), "foo"));
  rename["newName"] = "bar";
  CHECK(editor.ask("textDocument/rename", rename)["changes"][lsp::uri_of(second)][0]["range"]
                  ["start"]["line"] == Json(1));
  // No notice is sent.
  folder.write("b.probe",
               "use \"things.probe\"\n# one\n# two\nobject third like foo { friction 3 }\n");
  folder.write("things.probe", "# a line more\nobject foo { friction 1 }\n");
  const Json edit = editor.ask("textDocument/rename", rename);
  CHECK(edit["changes"][lsp::uri_of(second)][0]["range"]["start"]["line"] == Json(3));
  CHECK(edit["changes"][lsp::uri_of(folder.path() + "/things.probe")][0]["range"]["start"]
            ["line"] == Json(1));
  folder.write("b.probe", "use \"things.probe\"\nobject third like foo { friction\nobject\n");
  CHECK(editor.ask("textDocument/rename", rename).contains("error"));
}

TEST_CASE("a rename finds texts in hidden folders, and is refused where not all were looked at") {
  Folder folder;
  const std::string user = folder.write(
      "user.probe", "object foo { friction 1 }\nobject other like foo { friction 2 }\n");
  const std::string hidden =
      folder.write(".more/b.probe", "use \"../user.probe\"\nobject third like foo {}\n");
  Editor editor(folder.path());
  editor.open(user, text_of_file(user));
  Json rename = Editor::at(user, place_of(text_of_file(user), "foo"));
  rename["newName"] = "bar";
  CHECK(editor.ask("textDocument/rename", rename)["changes"].contains(lsp::uri_of(hidden)));
  std::string deep;
  for (int i = 0; i < 14; ++i) deep += "f/";
  folder.write(deep + "c.probe", "use \"" + user + "\"\nobject fourth like foo {}\n");
  CHECK(editor.ask("textDocument/rename", rename)["error"]["message"].text().find(
            "not every text of the folder was looked at: ") == 0);
  fs::remove_all(fs::path(folder.path()) / "f");
  CHECK(editor.ask("textDocument/rename", rename).contains("changes"));
  for (int i = 0; i < 1000; ++i)
    folder.write("many/t" + std::to_string(i) + ".probe", "");
  CHECK(editor.ask("textDocument/rename", rename)["error"]["message"].text().find(
            "not every text of the folder was looked at: ") == 0);
}

TEST_CASE("what the language or the library declares is not renamed") {
  Folder folder;
  const std::string path = folder.write("a.probe", "");
  Editor editor(folder.path());
  const std::string text =
      "use \"std/contact.probe\"\npredicate p() = height(source) > 1m\nmetrics m { a = once p() }\n";
  editor.open(path, text);
  CHECK(editor.ask("textDocument/prepareRename", Editor::at(path, place_of(text, "height")))
            .contains("error"));
  CHECK(editor.ask("textDocument/prepareRename", Editor::at(path, place_of(text, "source")))
            .contains("error"));
  CHECK(editor.ask("textDocument/prepareRename", Editor::at(path, place_of(text, "p()")))
            .contains("placeholder"));
}

TEST_CASE("fixes are actions, and all of a text are one") {
  Editor editor(kSuite);
  const std::string text = "use \"intact.probe\"\ntask a like carot_on_plate { source sponn }\n";
  Folder folder;
  const std::string path = kSuite + "/not_saved.probe";
  editor.open(path, text);
  Json params = Editor::document(path);
  const Json whole = {{"start", place_of(text, "use")}, {"end", {{"line", 9}, {"character", 0}}}};
  params["range"] = whole;
  params["context"] = {{"diagnostics", Json::array()}};
  const Json actions = editor.ask("textDocument/codeAction", params);
  REQUIRE(actions.size() >= 2);
  CHECK(actions.back()["kind"].text() == "source.fixAll.vlaprobe");
  const Json& edits = actions.back()["edit"]["changes"][lsp::uri_of(path)];
  CHECK(edits.size() == actions.size() - 1);
  CHECK(edits[0]["newText"].text() == "carrot_on_plate");
  params["context"]["only"] = Json::array({"source.fixAll"});
  CHECK(editor.ask("textDocument/codeAction", params).size() == 1);
}

TEST_CASE("layout is one edit of the lines that differ; a text with mistakes is left alone") {
  Folder folder;
  const std::string path = folder.write("a.probe", "");
  Editor editor(folder.path());
  editor.open(path, "role a\nrole   b\nrole c\n");
  const Json edits = editor.ask("textDocument/formatting", Editor::document(path));
  REQUIRE(edits.size() == 1);
  CHECK(edits[0]["newText"].text() == "role b\n");
  CHECK(edits[0]["range"]["start"]["line"] == Json(1));
  CHECK(edits[0]["range"]["end"]["line"] == Json(2));
  editor.change(path, "role {\n");
  CHECK(editor.ask("textDocument/formatting", Editor::document(path)).is_null());
}

TEST_CASE("signatures, hints and lenses") {
  Editor editor(kSuite);
  const std::string text = text_of_file(kIntact) + "predicate q() = distance(source, \n";
  editor.open(kIntact, text);
  const Json help = editor.ask("textDocument/signatureHelp",
                               Editor::at(kIntact, place_of(text, "distance(source, ", 17)));
  CHECK(help["activeParameter"] == Json(1));
  CHECK(help["signatures"][0]["label"].text() == "distance(point, point)");
  editor.change(kIntact, text_of_file(kIntact));
  Json params = Editor::document(kIntact);
  params["range"] = {{"start", {{"line", 0}, {"character", 0}}},
                     {"end", {{"line", 12}, {"character", 0}}}};
  CHECK(editor.ask("textDocument/inlayHint", params)[0]["label"].text() ==
        "\"put carrot on plate\", 24 starts");
  // What reads as one turn and is two.
  const std::string turned = "use \"intact.probe\"\nobject c like carrot { rest roll 90deg, yaw 90deg }\n";
  editor.open(kSuite + "/turned.probe", turned);
  params = Editor::document(kSuite + "/turned.probe");
  params["range"] = {{"start", {{"line", 0}, {"character", 0}}}, {"end", {{"line", 2}, {"character", 0}}}};
  CHECK(editor.ask("textDocument/inlayHint", params)[0]["label"].text() == "2 turns, one a start");
  const Json lenses = editor.ask("textDocument/codeLens", Editor::document(kIntact));
  CHECK(lenses[0]["command"]["title"].text() == "24 starts");
  CHECK(lenses[2]["command"]["command"].text() == "vlaprobe.runExpert");
}

TEST_CASE("an editor that asks for diagnostics is told of none unasked") {
  Editor editor(kSuite, {}, {{"textDocument", {{"diagnostic", Json::object()}}}});
  editor.open(kIntact, "use \"catalog.probe\"\nobject\n");
  CHECK(editor.codes(kIntact) == "nothing was published");
  const Json report = editor.ask("textDocument/diagnostic", Editor::document(kIntact));
  CHECK(report["kind"].text() == "full");
  CHECK(report["items"].size() == 1);
}

TEST_CASE("a text that is not open is not looked at, wherever it lies") {
  Editor editor(kSuite);
  for (const char* path : {"/etc/passwd", "/none.probe", ""}) {
    CAPTURE(path);
    CHECK(editor.ask("textDocument/documentSymbol", Editor::document(path)).contains("error"));
  }
  CHECK(editor.ask("textDocument/hover", Json::object()).contains("error"));
}

TEST_CASE("files that change on the disk or go away under an open text") {
  Folder folder;
  const std::string things = folder.write("things.probe", "object ball { friction 1 }\n");
  const std::string user =
      folder.write("user.probe", "use \"things.probe\"\nobject other like ball { friction 2 }\n");
  Editor editor(folder.path());
  editor.open(user, text_of_file(user));
  const std::string before = editor.codes(user);
  CHECK(before.find("P0201") == before.npos);
  folder.write("things.probe", "object globe { friction 1 }\n");
  editor.tell("workspace/didChangeWatchedFiles", {{"changes", Json::array()}});
  CHECK(editor.codes(user).find("P0201") == 0);
  fs::remove(things);
  fs::remove(user);
  editor.tell("workspace/didChangeWatchedFiles", {{"changes", Json::array()}});
  CHECK(editor.codes(user) == "P0202");
  folder.write("things.probe", "object ball { friction 1 }\n");
  editor.change(user, text_of_file(user) + "use \"things.probe\"\nobject other like ball {}\n");
  const std::string mended = editor.codes(user);
  CHECK(mended.find("P0202") == std::string::npos);
}

TEST_CASE("a text that was never saved has an address of its own") {
  Editor editor(kSuite);
  editor.open("untitled:Untitled-1", "object\n");
  CHECK(editor.codes("untitled:Untitled-1") == "P0101");
}

TEST_CASE("messages that are none are answered and change nothing") {
  Editor editor(kSuite);
  const std::size_t before = editor.messages().size();
  for (const char* message :
       {"", "{", "[]", "null", "7", "{\"id\":{}}", "{\"id\":1}", "{\"method\":3}",
        "{\"id\":[],\"method\":\"shutdown\"}", "{\"id\":1,\"method\":\"textDocument/hover\","
        "\"params\":[1]}", "\xff\xfe"}) {
    editor.raw(message);
  }
  CHECK(editor.messages().size() == before + 11);
  for (std::size_t i = before; i < before + 11; ++i) CHECK(editor.messages()[i].contains("error"));
  // Answers that nobody asked for, and notices with nothing in them.
  editor.raw("{\"id\":1,\"result\":null}");
  for (const char* method : {"textDocument/didOpen", "textDocument/didChange",
                             "textDocument/didClose", "$/cancelRequest", "initialized"})
    editor.tell(method, Json());
  CHECK(editor.messages().size() == before + 11);
}

TEST_CASE("changes that lie outside of the text are taken at its ends") {
  Folder folder;
  const std::string path = folder.write("a.probe", "");
  Editor editor(folder.path());
  editor.open(path, "role a\n");
  editor.change(path, {{"line", 900}, {"character", 9}}, {{"line", 4e9}, {"character", 1e300}},
                "role b\n");
  editor.change(path, {{"line", 1}, {"character", 6}}, {{"line", 0}, {"character", 5}}, "x");
  const Json symbols = editor.ask("textDocument/documentSymbol", Editor::document(path));
  REQUIRE(symbols.size() == 1);
  CHECK(symbols[0]["name"].text() == "x");
}

TEST_CASE("a text of five megabytes is answered") {
  Folder folder;
  const std::string path = folder.write("big.probe", "");
  std::string text;
  for (std::size_t i = 0; text.size() < (5u << 20); ++i)
    text += "object thing_" + std::to_string(i) + " { friction 0.5; name \"thing\" }\n";
  Editor editor(folder.path());
  editor.open(path, text);
  CHECK(editor.ask("textDocument/foldingRange", Editor::document(path)).is_array());
  CHECK(editor.ask("textDocument/hover", Editor::at(path, place_of(text, "thing_7 ")))
            .contains("contents"));
}
