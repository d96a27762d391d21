// The colours of queries/highlights.scm against those that the language server gives.
#include <algorithm>
#include <map>
#include <set>

#include "compiler/language/tokens.h"
#include "tests/dsl/tree_sitter/tree.h"

using namespace probe;

namespace {

// A file of queries, and what it captures of a text.
class Queries {
 public:
  explicit Queries(const char* file) : query_(nullptr, &ts_query_delete) {
    const std::string text = test::text_of(test::kGrammar / "queries" / file);
    std::uint32_t at = 0;
    TSQueryError error = TSQueryErrorNone;
    query_.reset(ts_query_new(tree_sitter_probe(), text.data(),
                              static_cast<std::uint32_t>(text.size()), &at, &error));
    REQUIRE_MESSAGE(query_ != nullptr, file, ": mistake at `", text.substr(at, 40), "`");
  }

  struct Capture {
    std::uint32_t begin, end;
    std::string name;
    const void* node;
  };
  std::vector<Capture> of(const test::Tree& tree) const {
    const std::unique_ptr<TSQueryCursor, decltype(&ts_query_cursor_delete)> cursor(
        ts_query_cursor_new(), &ts_query_cursor_delete);
    ts_query_cursor_exec(cursor.get(), query_.get(), tree.root());
    std::vector<Capture> out;
    TSQueryMatch match;
    for (std::uint32_t i = 0; ts_query_cursor_next_capture(cursor.get(), &match, &i);) {
      const TSQueryCapture& capture = match.captures[i];
      std::uint32_t size = 0;
      const char* name = ts_query_capture_name_for_id(query_.get(), capture.index, &size);
      out.push_back({ts_node_start_byte(capture.node), ts_node_end_byte(capture.node),
                     std::string(name, size), capture.node.id});
    }
    return out;
  }

 private:
  std::unique_ptr<TSQuery, decltype(&ts_query_delete)> query_;
};

// The type that the language server gives a name, and what it may be captured as.
const std::multimap<std::string_view, std::string_view> kNames = {
    {"class", "type"},
    {"type", "type"},
    {"namespace", "type"},
    {"interface", "type"},
    {"macro", "function.macro"},
    {"function", "function"},
    {"function", "constant"},  // `means leftmost`: a relation that looks like a fact
    {"class", "constant"},     // `means left_of plate`: an object that looks like a value
    {"parameter", "variable.parameter"},
    {"parameter", "label"},  // `refer source as p`: a phrase that a derive binds
    {"variable", "variable"},
    {"enum", "property"},
    {"enumMember", "constant"},
    {"property", "property"},
    {"string", "label"},
};

std::string_view name_of_type(std::uint32_t type) {
  return type < language::kTokenTypes.size()
             ? language::kTokenTypes[type]
             : language::kMoreTokenTypes[type - language::kTokenTypes.size()];
}

// By byte: 's' in a string, 'n' in a name, blank elsewhere.
std::vector<char> kinds_of(const test::Tree& tree, std::size_t size) {
  std::vector<char> out(size, ' ');
  const std::function<void(TSNode)> look = [&](TSNode node) {
    const std::string_view type = ts_node_type(node);
    const char kind = type == "string" || type == "template" ? 's'
                      : type == "identifier"                 ? 'n'
                                                             : ' ';
    if (kind != ' ')
      std::fill(out.begin() + ts_node_start_byte(node), out.begin() + ts_node_end_byte(node), kind);
    for (std::uint32_t i = 0; kind == ' ' && i < ts_node_child_count(node); ++i)
      look(ts_node_child(node, i));
  };
  look(tree.root());
  return out;
}

}  // namespace

TEST_CASE("no node has two colours, so that every editor shows the same") {
  const Queries queries("highlights.scm");
  for (const test::fs::path& path : test::all_texts()) {
    const test::Tree tree(test::text_of(path));
    std::set<const void*> seen;
    for (const Queries::Capture& capture : queries.of(tree))
      CHECK_MESSAGE(seen.insert(capture.node).second, test::in_tree(path), ":", capture.begin, ": ",
                    capture.name);
  }
}

TEST_CASE("colours agree with those of the language server") {
  const Queries queries("highlights.scm");
  const language::Setting setting{VLAPROBE_SOURCE_DIR "/assets", {VLAPROBE_SOURCE_DIR "/dsl"}};
  std::size_t compared = 0, names = 0, coloured_names = 0;
  for (const test::fs::path& path : test::all_texts()) {
    if (test::in_tree(path).starts_with("tests/golden")) continue;  // mistakes, names of nothing
    const auto snapshot = language::Snapshot::parsed(path.string(), {}, setting);
    REQUIRE(snapshot != nullptr);
    const std::string text = test::text_of(path);
    const test::Tree tree(text);
    // By byte: the capture; inner nodes come behind those around them.
    std::vector<std::string> ours(text.size());
    for (const Queries::Capture& capture : queries.of(tree))
      std::fill(ours.begin() + capture.begin, ours.begin() + capture.end, capture.name);
    std::vector<std::string_view> theirs(text.size());
    for (const language::ColouredToken& token : language::coloured(*snapshot, snapshot->root()))
      std::fill(theirs.begin() + token.span.begin, theirs.begin() + token.span.end,
                name_of_type(token.type));
    const std::vector<char> nodes = kinds_of(tree, text.size());
    std::map<std::string, std::string> differ;  // how: where
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == ' ') continue;
      const std::string_view their = theirs[i], own = ours[i];
      const bool in_string = nodes[i] == 's', is_word = nodes[i] == 'n';
      bool agree = true;
      if (own.starts_with("comment") || their == "comment") {
        agree = own.starts_with("comment") && their == "comment";
      } else if (in_string || (their == "string" && !is_word)) {
        // Names of slots stand for whoever fills them.
        agree = in_string && !own.empty() && own != "keyword.operator";
      } else if (own.starts_with("keyword")) {
        agree = their == "keyword";
      } else if (their == "keyword") {
        agree = is_word;  // a name that is not declared and is a word elsewhere: `from target`
      } else if (own == "number" || own == "type.builtin" || their == "number") {
        agree = (own == "number" || own == "type.builtin") && their == "number";
      } else if (is_word && !their.empty()) {
        ++names;
        coloured_names += own.empty() ? 0 : 1;
        const auto [first, last] = kNames.equal_range(their);
        agree = own.empty() ||
                std::any_of(first, last, [&](const auto& known) { return known.second == own; });
      } else {
        continue;  // signs; names that stand for nothing
      }
      ++compared;
      if (!agree) {
        const std::size_t begin = text.rfind('\n', i) + 1;
        differ.emplace(std::string(own) + " for " + std::string(their),
                       std::to_string(i - begin + 1) + " of `" +
                           text.substr(begin, text.find('\n', i) - begin) + "`");
      }
    }
    for (const auto& [how, where] : differ)
      CHECK_MESSAGE(false, test::in_tree(path), ": ", how, ", ", where);
  }
  MESSAGE(compared, " bytes compared; ", coloured_names * 100 / names,
          " % of the names' have a colour");
  CHECK(compared > 100000);
}

TEST_CASE("declarations and blocks can be folded") {
  const Queries queries("folds.scm");
  CHECK(queries.of(test::Tree("task a {\n source b\n}\nset c = d\nvariants of a {\n e { }\n}\n"))
            .size() == 3);
}
