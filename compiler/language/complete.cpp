// The grammar itself is asked: a name that nobody has is put where the cursor is, the file parsed,
// and what the parser takes it for is what can stand there.
#include "compiler/language/complete.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "compiler/define/denote.h"
#include "compiler/define/template.h"
#include "compiler/language/hover.h"
#include "compiler/language/signature.h"
#include "compiler/model/measures.h"
#include "compiler/syntax/lexer.h"
#include "runtime/plan/axes.h"

namespace probe::language {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kMark = "vlaprobe_is_completed_here";
constexpr int kKeywordItem = 14, kUnitItem = 11, kFileItem = 17, kConstantItem = 21;
// Ranks: what fits best before what may do.
constexpr std::uint32_t kClear = 0, kName = 1, kUnclear = 2, kOwn = 3, kWord = 4;

constexpr std::string_view kSets[] = {"fingers", "links",       "bodies", "objects",
                                      "others",  "distractors", "alike",  "parts"};

class Completer {
 public:
  Completer(const Snapshot& snapshot, FileId file, std::uint32_t offset, const Setting& setting)
      : snapshot_(snapshot), file_(file), setting_(setting), text_(snapshot.text(file)) {
    offset = static_cast<std::uint32_t>(std::min<std::size_t>(offset, text_.size()));
    begin_ = end_ = offset;
    while (begin_ > 0 && syntax::is_word(text_[begin_ - 1])) --begin_;
    while (end_ < text_.size() && syntax::is_word(text_[end_])) ++end_;
  }

  Suggestions run() {
    if (begin_ < end_ && syntax::is_digit(text_[begin_])) {
      units();
      return finish();
    }
    std::string marked(text_.substr(0, begin_));
    marked += kMark;
    if (is_in_open_slot()) marked += '}';
    marked += text_.substr(end_);
    SourceSet sources;
    const FileId id = sources.add(snapshot_.path(file_), std::move(marked));
    Diagnostics unsaid;
    const syntax::ParseResult parsed = syntax::parse(sources, id, unsaid);
    if (in_use(parsed)) return finish();
    if (in_comment(parsed)) return finish();
    for (const Place& place : names_in(parsed.file)) {
      if (place.text == kMark && !place.declares) names(place, parsed);
    }
    if (in_allow(parsed)) return finish();
    for (const std::string_view word : syntax::words_at(sources, id, begin_)) {
      if (syntax::is_letter(word.front()))
        add(word, "", kKeywordItem, kWord);
    }
    axes(sources, id);
    return finish();
  }

 private:
  Suggestions finish() {
    std::ranges::stable_sort(out_, {}, [](const Suggestion& item) {
      return std::pair(item.rank, std::string_view(item.label));
    });
    return {{file_, begin_, end_}, std::move(out_)};
  }

  Suggestion& add(std::string_view label, std::string detail, int kind, std::uint32_t rank) {
    if (!seen_.insert(std::string(label)).second) {
      static thread_local Suggestion spare;
      return spare = {};
    }
    out_.push_back({std::string(label), std::move(detail), {}, kind, rank});
    return out_.back();
  }

  // `12c|`: units of what the statement takes, else all.
  void units() {
    std::uint32_t digits = begin_;
    // Back over the part before a decimal point.
    if (begin_ >= 2 && text_[begin_ - 1] == '.' && syntax::is_digit(text_[begin_ - 2])) {
      for (digits = begin_ - 1; digits > 0 && syntax::is_digit(text_[digits - 1]);) --digits;
    }
    std::uint32_t behind = begin_;
    while (behind < end_ && syntax::is_digit(text_[behind])) ++behind;
    const sema::WantedNumber* wanted = nullptr;
    for (const sema::WantedNumber& number : snapshot_.wanted_numbers()) {
      if (number.span.file == file_ && number.span.begin <= digits && digits < number.span.end)
        wanted = &number;
    }
    begin_ = behind;
    for (const std::string_view unit : {
#define PROBE_UNIT(id, text, scale, length, time, angle, mass, pixel) std::string_view(text),
#include "compiler/syntax/units.def"
         }) {
      const auto one = sema::make_quantity("1", unit);
      const bool travels = wanted != nullptr && (wanted->dimension == sema::dim::kTravel);
      const bool fits =
          wanted == nullptr || !one || one->dimension == wanted->dimension ||
          (travels && (one->dimension == sema::dim::kLength ||
                       one->dimension == sema::dim::kAngle));
      if (fits && one) add(unit, name_of(one->dimension), kUnitItem, kName);
    }
  }

  // Between a `{` of a string and its closing quote.
  bool is_in_open_slot() const {
    const std::size_t line = text_.substr(0, begin_).find_last_of('\n') + 1;
    const std::string_view before = text_.substr(line, begin_ - line);
    const bool in_string = std::ranges::count(before, '"') % 2 == 1;
    const std::size_t last = before.find_last_of("\"{}");
    const std::string_view behind = text_.substr(end_);
    const std::size_t next = behind.find_first_of("\"{}\n");
    return in_string && last != before.npos && before[last] == '{' &&
           (next == behind.npos || behind[next] != '}');
  }

  bool in_comment(const syntax::ParseResult& parsed) const {
    return std::ranges::any_of(parsed.tokens.tokens, [&](const syntax::Token& token) {
      const bool is_one = token.kind == syntax::TokenKind::kComment ||
                          token.kind == syntax::TokenKind::kDocComment;
      return is_one && token.begin <= begin_ && begin_ < token.end;
    });
  }

  // `use "std/|"`: texts beside this one, and of the library.
  bool in_use(const syntax::ParseResult& parsed) {
    const syntax::Token* string = nullptr;
    const syntax::Token* before = nullptr;
    const syntax::Token* last = nullptr;
    for (const syntax::Token& token : parsed.tokens.tokens) {
      if (token.begin > begin_) break;
      if (syntax::is_trivia(token.kind)) continue;
      before = last;
      last = string = &token;
    }
    if (string == nullptr || string->kind != syntax::TokenKind::kString || before == nullptr)
      return false;
    if (before->kind != syntax::TokenKind::kIdent ||
        text_.substr(before->begin, before->end - before->begin) != "use")
      return false;
    // All between the quotes is one path.
    const std::uint32_t quote = string->begin + 1;
    const std::string written(text_.substr(quote, begin_ - quote));
    const std::string folder = written.substr(0, written.rfind('/') + 1);
    begin_ = quote + static_cast<std::uint32_t>(folder.size());
    while (end_ < text_.size() && text_[end_] != '"' && text_[end_] != '\n') ++end_;
    std::vector<fs::path> roots{fs::path(snapshot_.path(file_)).parent_path()};
    for (const std::string& library : setting_.library_folders) roots.emplace_back(library);
    for (const fs::path& root : roots) list_texts(root / folder);
    return true;
  }
  void list_texts(const fs::path& folder) {
    constexpr std::size_t kMost = 500;
    std::error_code error;
    std::vector<std::pair<std::string, bool>> found;
    for (fs::directory_iterator at(folder, error), end; !error && at != end;
         at.increment(error)) {
      const std::string name = at->path().filename().string();
      const bool is_folder = at->is_directory(error);
      if (name.starts_with('.') || (!is_folder && !name.ends_with(".probe"))) continue;
      if (!is_folder && (folder / name).lexically_normal() == snapshot_.path(file_)) continue;
      found.emplace_back(is_folder ? name + "/" : name, is_folder);
      if (found.size() == kMost) break;
    }
    for (const auto& [name, is_folder] : found)
      add(name, is_folder ? "folder" : "text", kFileItem, is_folder ? kUnclear : kName);
  }

  // `@allow(|`
  bool in_allow(const syntax::ParseResult& parsed) {
    const auto& tokens = parsed.tokens.tokens;
    for (std::size_t i = 3; i < tokens.size(); ++i) {
      if (tokens[i].begin != begin_) continue;
      const bool is_open = tokens[i - 1].kind == syntax::TokenKind::kLeftParen &&
                           tokens[i - 2].kind == syntax::TokenKind::kIdent &&
                           tokens[i - 3].kind == syntax::TokenKind::kAt;
      if (!is_open) return false;
      for (const Code code : all_codes()) {
        if (!probe::info(code).slug.empty())
          add(probe::info(code).slug, std::string(probe::info(code).text) + ": " +
                                          std::string(probe::info(code).title),
              kConstantItem, kName);
      }
      return true;
    }
    return false;
  }

  // `axis |`, `uses |`, `phrase p |`, `paint |`: names that tables have.
  void axes(const SourceSet& sources, FileId id) {
    const std::string_view before = sources.file(id).text().substr(0, begin_);
    std::vector<std::string_view> words;  // the last three of the line
    std::string_view line = before.substr(before.find_last_of("\n;{") + 1);
    while (!line.empty()) {
      const std::size_t begin = line.find_first_not_of(" \t");
      if (begin == line.npos) break;
      line.remove_prefix(begin);
      const std::size_t size = std::min(line.find_first_of(" \t"), line.size());
      words.push_back(line.substr(0, size));
      line.remove_prefix(size);
    }
    if (words.empty()) return;
    const std::string_view last = words.back();
    const bool is_phrase = words.size() == 2 && words.front() == "phrase";
    for (const plan::AxisInfo& axis : plan::kAxisTable) {
      if (last == "axis") add(axis.name, "axis", kConstantItem, kName);
      if (last == "uses" && axis.is_language()) add(axis.word(), "axis", kConstantItem, kName);
      if (is_phrase && axis.is_phrase) add(axis.word(), "axis", kConstantItem, kName);
    }
    if (last != "paint") return;
#define PROBE_PAINT(name, red, green, blue) add(#name, "colour", kConstantItem, kName);
#include "compiler/define/paints.def"
  }

  void names(const Place& place, const syntax::ParseResult& parsed) {
    const Index& index = snapshot_.index();
    for (std::size_t i = 0; i < kKindCount; ++i) {
      const auto kind = static_cast<Kind>(i);
      if (!place.may_be.has(kind)) continue;
      if (kind == Kind::kVariable) {
        variables(place, parsed);
      } else if (kind == Kind::kPhrase) {
        phrases(place, parsed);
      } else if (kind == Kind::kMember) {
        members(place);
      } else if (kind == Kind::kMeasure) {
        measures();
      } else {
        for (const Place* declared : index.declared(kind)) {
          if (kind == Kind::kValue && declared->of != place.of) continue;
          Suggestion& item = add(declared->text, std::string(info(kind).word), info(kind).item,
                                 kName);
          if (!item.label.empty()) item.documentation = declaration_text(snapshot_, *declared);
        }
        built_in(kind);
      }
    }
    // In a set of bodies.
    if (place.may_be.has(Kind::kRole) && place.may_be.has(Kind::kVariable) &&
        !place.may_be.has(Kind::kObject)) {
      for (const std::string_view set : kSets) add(set, "set of bodies", kConstantItem, kOwn);
    }
    if (place.may_be.has(Kind::kTask)) {
      // Those that a `derive` makes, but not thousands of them.
      constexpr std::size_t kMost = 200;
      std::size_t count = 0;
      for (const sema::Task& task : snapshot_.model().tasks) {
        if (task.derived && ++count <= kMost)
          add(task.name, "derived task", info(Kind::kTask).item, kUnclear);
      }
    }
  }

  void built_in(Kind kind) {
    if (kind != Kind::kRole) return;
    for (const std::string_view role : {"source", "target"})
      add(role, "role", info(Kind::kRole).item, kName);
  }

  void variables(const Place& place, const syntax::ParseResult& parsed) {
    for (const Place& known : names_in(parsed.file)) {
      if (known.declares && known.may_be.has(Kind::kVariable) && known.text != kMark &&
          is_within(place.span, known.scope))
        add(known.text, "variable", info(Kind::kVariable).item, kClear);
    }
  }

  void measures() {
    for (const sema::MeasureInfo& measure : sema::all_measures()) {
      add(measure.name, "measure", info(Kind::kMeasure).item, kOwn).documentation =
          std::string(measure.meaning);
    }
    add("surface", "body", kConstantItem, kOwn);
  }

  void members(const Place& place) {
    const sema::Model& model = snapshot_.model();
    for (const sema::Fixture& fixture : model.fixtures) {
      if (fixture.name != place.of) continue;
      for (const auto& part : fixture.parts) {
        if (part.declared) add(part.name, "part", info(Kind::kMember).item, kName);
      }
      for (const auto& joint : fixture.joints)
        add(joint.name, "joint", info(Kind::kMember).item, kName);
      for (const auto& region : fixture.regions)
        add(region.region.name, "region", info(Kind::kMember).item, kName);
      return;
    }
    for (const Place* declared : snapshot_.index().declared(Kind::kMember))
      add(declared->text, "of `" + std::string(declared->of) + "`", info(Kind::kMember).item,
          kUnclear);
  }

  // The task that the place is in, as it was when its text could be read.
  const sema::Task* task_of(const syntax::ParseResult& parsed) const {
    const sema::Task* found = nullptr;
    for (const Place& known : names_in(parsed.file)) {
      if (known.declares && known.may_be.has(Kind::kTask) && known.whole.begin <= begin_ &&
          begin_ <= known.whole.end)
        found = snapshot_.task(known.text);
    }
    return found;
  }

  // What each phrase means here: those that mean their object alone come first.
  void phrases(const Place& place, const syntax::ParseResult& parsed) {
    const sema::Model& model = snapshot_.model();
    const sema::Task* task = task_of(parsed);
    if (task != nullptr) {
      const std::vector<sema::ObjectId> objects = task->objects();
      for (const sema::ObjectId id : objects) {
        const sema::RoleId role = task->role_of(id);
        if (role == sema::RoleId::kNone || model.roles[role].name != place.of) continue;
        const sema::Object& object = model.objects[id];
        for (const sema::Phrase& phrase : object.phrases) {
          const sema::Denotation means = sema::denote(model, objects, phrase, id);
          std::string detail = "\"" + phrase.text.text + "\": ";
          const bool is_clear = means.is_clear() && !phrase.is_spatial();
          if (phrase.is_spatial()) {
            detail += "says where it is, start by start";
          } else if (is_clear) {
            detail += "`" + object.name + "` alone";
          } else if (!means.fits) {
            detail += "does not fit `" + object.name + "`";
          } else {
            const sema::ObjectId other =
                means.sure.empty() ? means.perhaps.front() : means.sure.front();
            detail += std::string(means.sure.empty() ? "perhaps " : "") + "also `" +
                      model.objects[other].name + "`";
          }
          add(phrase.name, std::move(detail), info(Kind::kPhrase).item,
              is_clear ? kClear : kUnclear);
        }
      }
    }
    for (const Place* declared : snapshot_.index().declared(Kind::kPhrase))
      add(declared->text, "phrase", info(Kind::kPhrase).item, kOwn);
  }

  const Snapshot& snapshot_;
  FileId file_;
  const Setting& setting_;
  std::string_view text_;
  std::uint32_t begin_ = 0, end_ = 0;  // the word at the place
  std::vector<Suggestion> out_;
  std::set<std::string> seen_;
};

}  // namespace

Suggestions complete(const Snapshot& snapshot, FileId file, std::uint32_t offset,
                     const Setting& setting) {
  return Completer(snapshot, file, offset, setting).run();
}

}  // namespace probe::language
