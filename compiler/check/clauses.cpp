#include "compiler/check/clauses.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>

#include "compiler/check/called.h"
#include "compiler/check/said.h"
#include "compiler/define/template.h"
#include "runtime/base/check.h"
#include "runtime/base/utf8.h"

namespace probe::sema {
namespace {

enum class WordIs : std::uint8_t {
  kUnknown,
  kPuts,
  kTakes,
  kOpens,
  kCloses,
  kDoes,
  kTo,
  kBeside,
  kFrom,
  kAt,
  kWith,
  kJoins,
  kAnd,
  kOr,
  kIt,
  kThe,
  kEach,
  kSome,
  kIs,
  kWhere,
  kBegins,
  kTurn,
  kRepeats,
  kPlace,
  kShut,
  kIdle,
  kSpares,
  kDenies
};
struct ClauseWord {
  std::vector<std::string> words;
  WordIs is;
};

// By the first word, the longest first.
const std::multimap<std::string, ClauseWord, std::less<>>& clause_words() {
  static const auto table = [] {
    std::vector<ClauseWord> all;
#define PROBE_CLAUSE_WORD(words, is) all.push_back({folded_words(words), WordIs::is});
#include "compiler/check/clause_words.def"
    std::stable_sort(all.begin(), all.end(), [](const ClauseWord& a, const ClauseWord& b) {
      return a.words.size() > b.words.size();
    });
    std::multimap<std::string, ClauseWord, std::less<>> by_first;
    for (ClauseWord& one : all) {
      std::string first = one.words.front();
      by_first.emplace(std::move(first), std::move(one));
    }
    return by_first;
  }();
  return table;
}

struct Token {
  std::string text;  // folded; of a slot empty
  Things of;         // what a slot means
  bool is_slot = false, is_set = false;
  bool ends = false;  // a sign follows
  std::string shown;  // as it is quoted
};

// The declared parts and the regions of a fixture.
Things things_of(const Model& model, FixtureId id) {
  Things found;
  for (const Fixture::Part& part : model.fixtures[id].parts) found.insert(part.thing);
  for (const Fixture::OwnRegion& region : model.fixtures[id].regions) found.insert(region.thing);
  found.erase(ObjectId::kNone);
  return found;
}

// The words of an instruction. A sign that stands alone, as behind a slot, belongs to what it
// follows.
std::vector<Token> tokens_of(const Model& model, const Task& task) {
  std::vector<Token> tokens;
  const Template& say = model.templates[task.say];
  for (const Template::Part& part : say.parts) {
    if (part.slot) {
      const auto meant = meant_by(model, task, say, *part.slot);
      Token token;
      token.of = Things(meant.begin(), meant.end());
      token.is_slot = true;
      token.is_set = part.slot->role != RoleId::kNone && model.roles[part.slot->role].is_set;
      if (const auto fixture = fixture_of(model, *part.slot)) token.of = things_of(model, *fixture);
      for (const ObjectId id : token.of)
        token.shown += (token.shown.empty() ? "the " : " and the ") + model.objects[id].text.text;
      if (token.of.empty()) token.shown = part.slot->name.text;
      tokens.push_back(std::move(token));
      continue;
    }
    constexpr std::string_view kSigns = ".,;:!?()";
    const std::string& text = part.literal;
    if (!text.empty() && kSigns.find(text.front()) != kSigns.npos && !tokens.empty())
      tokens.back().ends = true;
    for (Said::Word& word : words_in(text)) {
      Token token;
      token.shown = word.text;
      token.text = std::move(word.text);
      token.ends = word.ends;
      tokens.push_back(std::move(token));
    }
  }
  return tokens;
}

// Reads clauses one after the other, each as far as it goes.
class ClauseReader {
 public:
  ClauseReader(const Model& model, const Task& task, Callings& callings)
      : called_(model, task, callings), words_(tokens_of(model, task)) {}

  Clauses run() {
    while (at_ < words_.size()) {
      const Match word = match(at_);
      const std::size_t before = at_;
      if (denies_first(word)) {
        at_ += word.length;
        clause(match(at_));
        out_.all.back().denied = true;
        // "Do not put it there before ..": later it may.
        if (at_ < words_.size() && words_[at_].text == "before") doubt(out_.all.back(), at_);
        stop();
        break;
      }
      if (word.is == WordIs::kSpares && kept()) continue;
      if (word.is == WordIs::kSpares || word.is == WordIs::kDenies) {
        const bool is_inside = word.is == WordIs::kDenies && at_ > 0 && !is_apart(at_);
        if (is_inside && !out_.all.empty()) doubt(out_.all.back(), at_);
        stop();
        break;
      }
      if (is_verb(word.is)) {
        clause(word);
      } else if (joins(word.is) || word.is == WordIs::kIdle || word.is == WordIs::kTurn) {
        joined_ = joined_ || joins(word.is);
        at_ += word.length;
      } else if (!leading_place() && !same_again() && !turn() && !stated()) {
        unknown();
      }
      PROBE_CHECK(at_ > before, "a clause has words");
    }
    return std::move(out_);
  }

 private:
  struct Match {
    WordIs is = WordIs::kUnknown;
    std::size_t length = 0;
  };

  Match match(std::size_t at) const {
    if (at >= words_.size() || words_[at].is_slot) return {};
    const auto [from, to] = clause_words().equal_range(words_[at].text);
    for (auto one = from; one != to; ++one) {
      const auto& wanted = one->second.words;
      std::size_t k = 1;
      while (k < wanted.size() && at + k < words_.size() && words_[at + k].text == wanted[k] &&
             !words_[at + k - 1].ends)
        ++k;
      if (k == wanted.size()) return {one->second.is, k};
    }
    return {};
  }
  // "Do not put the cup ..", "avoid putting it ..".
  bool denies_first(const Match& word) const {
    if (!out_.all.empty() || !is_verb(match(at_ + word.length).is)) return false;
    const std::string& text = words_[at_].text;
    return text == "not" || text == "don't" || text == "never" || text == "avoid" ||
           text == "refrain";
  }
  static bool is_verb(WordIs is) { return is >= WordIs::kPuts && is <= WordIs::kDoes; }
  static bool is_place(WordIs is) { return is >= WordIs::kTo && is <= WordIs::kWith; }
  static bool joins(WordIs is) {
    return is == WordIs::kJoins || is == WordIs::kAnd || is == WordIs::kOr;
  }
  bool ends_at(std::size_t at) const { return at > 0 && words_[at - 1].ends; }
  // Whether something stands between these words and those before them.
  bool is_apart(std::size_t at) const { return ends_at(at) || joined_; }

  // A noun with what stands before it.
  struct Noun {
    std::vector<Clause::What> what;
    std::size_t end = 0;
    bool is_place = false;  // no thing
  };

  // What stands before a noun, and where that begins.
  std::size_t before_noun(std::size_t at, Clause::What& how) const {
    for (; at < words_.size() && !words_[at].is_slot;) {
      const std::string& text = words_[at].text;
      const Match word = match(at);
      if (word.is == WordIs::kThe || word.is == WordIs::kEach) {
        if (text == "both") how.count = 2;
        how.is_each = how.is_each || word.is == WordIs::kEach;
        // Of one noun; what is behind "one of" has an article of its own.
        how.is_some = how.is_some || text == "a" || text == "an";
        at += word.length;
        continue;
      }
      // "One cube", not "put the other one".
      const bool is_one = word.is == WordIs::kIt && text == "one" &&
                          called_.find(texts(at + 1, 4)).length > 0;
      if (word.is == WordIs::kSome || is_one) {
        how.is_some = true;
        at += word.length;
        continue;
      }
      const std::size_t number = number_of(text);
      if (number == 0) break;
      how.count = number;
      ++at;
      // "Two of the three": which, is not said.
      if (text == "both" || at >= words_.size() || words_[at].text != "of") continue;
      how.is_some = how.is_some || !how.is_each;
      ++at;
    }
    return at;
  }

  // Nothing where the words at `at` are no noun that is known.
  std::optional<Noun> noun(std::size_t at) {
    Noun found;
    Clause::What how;
    at = before_noun(at, how);
    if (at >= words_.size()) return std::nullopt;
    if (words_[at].is_slot) {
      found.end = at + 1;
      if (words_[at].is_set && !how.is_some) {
        for (const ObjectId one : words_[at].of) found.what.push_back({{one}, 0, false});
      } else {
        found.what.push_back({words_[at].of, 0, false, false, false, how.is_some});
      }
      return found;
    }
    const Match word = match(at);
    if (word.is == WordIs::kIt) {
      found.what.push_back({out_.said, 0, true});
      found.end = at + word.length;
      return found;
    }
    if (const Called::Found name = called_.find(texts(at, 5)); name.length > 0) {
      out_.is_pure = false;
      how.of = name.of;
      how.is_several = name.is_plural;
      if (!name.is_plural) how.count = 0;
      found.what.push_back(std::move(how));
      found.end = at + name.length;
      of_what(found);
      return found;
    }
    if (word.is == WordIs::kPlace) {
      found.is_place = true;
      found.end = at + word.length;
      return found;
    }
    if (word.is != WordIs::kUnknown) return std::nullopt;
    if (auto of_two = shared_noun(at)) return of_two;
    // "The ripe banana": a word that tells no two things apart.
    const Called::Found name = called_.find(texts(at + 1, 4));
    if (name.length == 0 || name.of.size() != 1 || words_[at].ends) return std::nullopt;
    out_.is_pure = false;
    found.what.push_back({name.of, 0, false});
    found.end = at + 1 + name.length;
    return found;
  }

  // "The top drawer of the cabinet".
  void of_what(Noun& found) {
    if (found.end >= words_.size() || words_[found.end].text != "of" || ends_at(found.end)) return;
    const auto owner = noun(found.end + 1);
    if (!owner || owner->is_place || owner->what.size() != 1) return;
    found.end = owner->end;
    Things& of = found.what.front().of;
    Things mine;
    for (const ObjectId thing : of) {
      if (called_.has_part(owner->what.front().of, thing)) mine.insert(thing);
    }
    if (mine.empty()) mine.insert(owner->what.front().of.begin(), owner->what.front().of.end());
    of = std::move(mine);
  }

  // "The green and the yellow cube".
  std::optional<Noun> shared_noun(std::size_t at) {
    if (!called_.is_adjective(words_[at].text)) return std::nullopt;
    std::size_t next = at + 1;
    if (match(next).is == WordIs::kAnd) {
      next += match(next).length;
    } else if (!words_[at].ends) {
      return std::nullopt;
    }
    auto rest = noun(next);
    if (!rest || rest->is_place || words_[rest->end - 1].is_slot) return std::nullopt;
    const Called::Found name = called_.find({words_[at].text, words_[rest->end - 1].text});
    if (name.length != 2) return std::nullopt;
    rest->what.insert(rest->what.begin(), {name.of, 0, false});
    return rest;
  }

  std::vector<std::string> texts(std::size_t at, std::size_t most) const {
    std::vector<std::string> found;
    for (; at < words_.size() && found.size() < most && !words_[at].is_slot; ++at) {
      found.push_back(words_[at].text);
      if (words_[at].ends) break;
    }
    return found;
  }

  // Nouns with "and" between them, and signs before the last of them.
  std::optional<Noun> nouns(std::size_t at, bool is_where) {
    auto found = noun(at);
    if (!found) return std::nullopt;
    std::optional<Noun> sure = found;
    while (found->end < words_.size()) {
      const Match joint = match(found->end);
      const bool is_and = joint.is == WordIs::kAnd;
      std::size_t next = found->end;
      if (is_and) {
        next += joint.length;
      } else if (!words_[found->end - 1].ends) {
        break;
      }
      if (is_verb(match(next).is) && called_.find(texts(next, 5)).length == 0) break;
      const bool was_pure = out_.is_pure;
      auto more = noun(next);
      // "On the plate and the cup on the tray": another thing goes there.
      if (!more || more->is_place || (is_where && begins_again(next))) {
        out_.is_pure = was_pure;
        break;
      }
      found->end = more->end;
      found->what.insert(found->what.end(), more->what.begin(), more->what.end());
      if (is_and) sure = found;
    }
    // "One of the cube and the can".
    if (sure->what.size() > 1 && sure->what.front().is_some && sure->what.front().of.size() == 1)
      take_either(*sure);
    return sure;
  }

  static void take_either(Noun& nouns) {
    Clause::What all;
    all.is_some = true;
    for (const Clause::What& one : nouns.what) all.of.insert(one.of.begin(), one.of.end());
    nouns.what = {std::move(all)};
  }

  // "The cube or the can".
  void or_another(Noun& found) {
    const Match joint = match(found.end);
    const std::size_t at = found.end + joint.length;
    if (joint.is != WordIs::kOr || ends_at(found.end) || is_verb(match(at).is)) return;
    const auto other = noun(at);
    if (!other || other->is_place) return;
    found.end = other->end;
    found.what.insert(found.what.end(), other->what.begin(), other->what.end());
    take_either(found);
  }

  // Whether nouns stand here, and a place behind them.
  bool begins_again(std::size_t at) {
    const auto what = nouns(at, false);
    if (!what) return false;
    std::size_t next = what->end;
    while (match(next).is == WordIs::kIdle) next += match(next).length;
    return is_place(match(next).is) && !ends_at(next);
  }

  void clause(const Match& verb) {
    Clause clause;
    switch (verb.is) {
      case WordIs::kPuts:
        clause.does = Clause::Does::kPuts;
        break;
      case WordIs::kTakes:
        clause.does = Clause::Does::kTakes;
        break;
      case WordIs::kOpens:
        clause.does = Clause::Does::kOpens;
        break;
      case WordIs::kCloses:
        clause.does = Clause::Does::kCloses;
        break;
      default:
        break;
    }
    const std::size_t from = at_;
    at_ += verb.length;
    finish(std::move(clause), from);
  }

  void idle(Clause& clause) {
    while (at_ < words_.size()) {
      const Match word = match(at_);
      if (word.is == WordIs::kRepeats) clause.repeats = shown(at_, at_ + word.length);
      if (word.is == WordIs::kTurn && !clause.what.empty())
        turn_ = words_[at_].text == "last" ? Ordinal::kLast : Ordinal::kFirst;
      if (word.is == WordIs::kRepeats || word.is == WordIs::kTurn) {
        at_ += word.length;
        if (ends_at(at_)) return;
        continue;
      }
      // "Drop it off on the plate".
      const bool is_particle = word.is == WordIs::kFrom && !noun(at_ + word.length);
      if (word.is != WordIs::kIdle && !is_particle) return;
      at_ += word.length;
      if (ends_at(at_)) return;
    }
  }

  // What stands behind the verb.
  void finish(Clause clause, std::size_t from) {
    turn_ = Ordinal::kNone;
    idle(clause);
    // A clause without a verb begins behind a sign.
    if (at_ == from || !ends_at(at_)) {
      if (auto what = nouns(at_, false); what && !what->is_place) {
        or_another(*what);
        clause.what = what->what;
        at_ = what->end;
      }
    }
    Things where = pending_;
    clause.goes = !pending_.empty();
    pending_.clear();
    while (at_ < words_.size()) {
      if (aside()) continue;
      if (ends_at(at_) && !is_place(match(at_).is)) break;
      idle(clause);
      const Match word = match(at_);
      // "Pull the drawer open".
      const bool is_shut = word.is == WordIs::kShut || word.is == WordIs::kCloses;
      if ((is_shut || word.is == WordIs::kOpens) && !ends_at(at_) &&
          clause.does == Clause::Does::kOther) {
        clause.does = is_shut ? Clause::Does::kCloses : Clause::Does::kOpens;
        at_ += word.length;
        continue;
      }
      if (word.is == WordIs::kPlace && !ends_at(at_)) {
        at_ += word.length;
        unsure_ = true;
        continue;
      }
      if (!is_place(word.is)) break;
      if (!place(word, clause, where)) {
        doubt(clause, at_ + word.length);
        break;
      }
    }
    clause.where = std::move(where);
    if (unsure_ || clause.where.empty()) clause.goes = false;
    unsure_ = false;
    for (const Clause::What& one : clause.what) out_.said.insert(one.of.begin(), one.of.end());
    out_.said.insert(clause.where.begin(), clause.where.end());
    joined_ = false;
    if (at_ < words_.size() && !ends_at(at_)) {
      const Match next = match(at_);
      const bool is_known =
          joins(next.is) || next.is == WordIs::kSpares || next.is == WordIs::kBegins;
      if (!is_known || next.is == WordIs::kOr) doubt(clause, at_);
    }
    clause.words = shown(from, at_);
    if (turn_ != Ordinal::kNone) {
      for (const Clause::What& one : clause.what)
        out_.ranks.push_back({one.of, turn_ == Ordinal::kLast, clause.words});
    }
    last_ = clause.does;
    out_.all.push_back(std::move(clause));
  }

  // "Put the cube, not the can, on the tray".
  bool aside() {
    if (match(at_).is != WordIs::kDenies || words_[at_].text != "not") return false;
    const auto other = noun(at_ + 1);
    if (!other || other->is_place) return false;
    const WordIs next = match(other->end).is;
    if (!is_place(next) && next != WordIs::kDenies) return false;
    Things of;
    for (const Clause::What& one : other->what) of.insert(one.of.begin(), one.of.end());
    out_.said.insert(of.begin(), of.end());
    out_.left.push_back({shown(at_, other->end), std::move(of), true});
    at_ = other->end;
    return true;
  }

  std::string shown(std::size_t from, std::size_t to) const {
    std::string text;
    for (std::size_t i = from; i < to && i < words_.size(); ++i)
      text += (i > from ? " " : "") + words_[i].shown;
    return text;
  }
  // A clause is not understood, from this word on.
  void doubt(Clause& clause, std::size_t at) const {
    if (clause.certain && at < words_.size()) clause.stopped = words_[at].shown;
    clause.certain = false;
  }

  // "On the plate". False where it is not known what that is.
  bool place(const Match& word, Clause& clause, Things& where) {
    const std::size_t at = at_;
    const auto to = nouns(at_ + word.length, true);
    if (!to) return inside(word, clause, where);
    at_ = to->end;
    for (const Clause::What& one : to->what) out_.said.insert(one.of.begin(), one.of.end());
    if (word.is == WordIs::kFrom) {
      for (const Clause::What& one : to->what) clause.from.insert(one.of.begin(), one.of.end());
    }
    if (word.is == WordIs::kFrom || word.is == WordIs::kWith) return true;
    // "Pick up the cup on the plate": which cup. "Take it to the plate": where to.
    if (clause.does == Clause::Does::kTakes) {
      if (word.is != WordIs::kTo) return true;
      clause.does = Clause::Does::kPuts;
    }
    if (to->is_place) {
      unsure_ = true;
      const std::string& place = words_[to->end - 1].text;
      if (place != "there" && place != "here") clause.ground = place;
      return true;
    }
    const Clause::Where lies = lies_as(word, at);
    clause.lies = clause.goes && clause.lies != lies ? Clause::Where::kMixed : lies;
    clause.goes = true;
    for (const Clause::What& one : to->what) {
      where.insert(one.of.begin(), one.of.end());
      clause.is_anywhere = clause.is_anywhere || one.is_some;
    }
    return true;
  }

  Clause::Where lies_as(const Match& word, std::size_t at) const {
    if (word.is == WordIs::kBeside) return Clause::Where::kBeside;
    constexpr auto kOn =
        std::to_array<std::string_view>({"on", "upon", "atop", "onto", "over", "above"});
    constexpr auto kUnder = std::to_array<std::string_view>({"under", "below"});
    const std::string& text = words_[at].text;
    if (word.is == WordIs::kTo && text != "onto") return Clause::Where::kElsewhere;
    if (std::ranges::find(kOn, text) != kOn.end()) return Clause::Where::kOn;
    if (std::ranges::find(kUnder, text) != kUnder.end()) return Clause::Where::kUnder;
    return Clause::Where::kElsewhere;
  }

  // "Open the drawer and put the cup inside": in something that was spoken of.
  bool inside(const Match& word, Clause& clause, Things& where) {
    const std::size_t next = at_ + word.length;
    const bool is_last = next == words_.size() || ends_at(next) || joins(match(next).is);
    if (words_[at_].text != "inside" || word.length > 1 || !is_last || out_.said.empty())
      return false;
    at_ = next;
    where = out_.said;
    clause.goes = true;
    return true;
  }

  // "On the plate, put the cup".
  bool leading_place() {
    const Match word = match(at_);
    if (!is_place(word.is) || word.is == WordIs::kFrom || word.is == WordIs::kWith) return false;
    if (!out_.all.empty() && !ends_at(at_)) return false;
    const auto to = nouns(at_ + word.length, true);
    if (!to || to->is_place || !is_verb(match(to->end).is)) return false;
    at_ = to->end;
    for (const Clause::What& one : to->what) pending_.insert(one.of.begin(), one.of.end());
    return true;
  }

  // "..., then the cup on the tray": as the verb before.
  bool same_again() {
    if (out_.all.empty() || last_ != Clause::Does::kPuts || !begins_again(at_)) return false;
    Clause clause;
    clause.does = last_;
    finish(std::move(clause), at_);
    return true;
  }

  // "Leave it open", "keep the drawer closed": as if that were done last.
  bool kept() {
    const std::string& text = words_[at_].text;
    if (text != "leave" && text != "keep") return false;
    const auto what = noun(at_ + 1);
    if (!what || what->is_place || ends_at(what->end)) return false;
    const WordIs is = match(what->end).is;
    if (is != WordIs::kOpens && is != WordIs::kShut) return false;
    if (is == WordIs::kOpens && words_[what->end].text != "open") return false;
    const std::size_t from = at_;
    Clause clause;
    clause.does = is == WordIs::kOpens ? Clause::Does::kOpens : Clause::Does::kCloses;
    clause.what = what->what;
    at_ = what->end + 1;
    finish(std::move(clause), from);
    return true;
  }

  // "The cube last", "beginning with the cube".
  bool turn() {
    const Match word = match(at_);
    const bool begins = word.is == WordIs::kBegins;
    const auto what = noun(begins ? at_ + word.length : at_);
    if (!what || what->is_place) return false;
    std::size_t end = what->end;
    const bool is_last = match(end).is == WordIs::kTurn && words_[end].text == "last";
    if (!begins) {
      if (match(end).is != WordIs::kTurn || ends_at(end)) return false;
      end += match(end).length;
    }
    if (end < words_.size() && !ends_at(end) && !joins(match(end).is)) return false;
    for (const Clause::What& one : what->what) {
      out_.ranks.push_back({one.of, !begins && is_last, shown(at_, end)});
      out_.said.insert(one.of.begin(), one.of.end());
    }
    at_ = end;
    return true;
  }

  // "The tray is where the cube should go".
  bool stated_where(const Noun& place) {
    const auto what = noun(place.end + match(place.end).length);
    if (!what || what->is_place || match(what->end).is != WordIs::kIs) return false;
    const std::size_t from = at_;
    Clause clause;
    clause.does = Clause::Does::kPuts;
    clause.what = what->what;
    for (const Clause::What& one : place.what) pending_.insert(one.of.begin(), one.of.end());
    at_ = what->end + match(what->end).length;
    finish(std::move(clause), from);
    return true;
  }

  // "The cube should be on the tray", and "the cube on the tray" as all that is said.
  bool stated() {
    const auto what = noun(at_);
    if (!what || what->is_place || ends_at(what->end)) return false;
    const Match is = match(what->end);
    if (is.is == WordIs::kWhere) return stated_where(*what);
    const bool is_all = at_ == 0 && is_place(is.is) && is.is != WordIs::kFrom &&
                        is.is != WordIs::kWith;
    if (is.is != WordIs::kIs && !is_all) return false;
    const std::size_t from = at_;
    Clause clause;
    clause.does = Clause::Does::kPuts;
    clause.what = what->what;
    at_ = what->end;
    while (match(at_).is == WordIs::kIs) at_ += match(at_).length;
    if (!is_place(match(at_).is)) {
      at_ = from;
      return false;
    }
    finish(std::move(clause), from);
    return true;
  }

  // What is not understood speaks of what is named in it, and may belong to what stands before it.
  void unknown() {
    out_.is_whole = false;
    if (!out_.all.empty() && !is_apart(at_)) doubt(out_.all.back(), at_);
    constexpr auto kBack =
        std::to_array<std::string_view>({"which", "that", "who", "where", "when", "while", "so"});
    if (!out_.all.empty() && std::find(kBack.begin(), kBack.end(), words_[at_].text) != kBack.end())
      doubt(out_.all.back(), at_);
    const std::size_t from = at_;
    Things of;
    do {
      of.merge(speak(at_));
      ++at_;
    } while (at_ < words_.size() && !ends_at(at_) && !joins(match(at_).is) &&
             match(at_).is != WordIs::kSpares && match(at_).is != WordIs::kDenies);
    out_.left.push_back({shown(from, at_), std::move(of), false});
    joined_ = true;
    last_ = Clause::Does::kOther;
  }

  void stop() {
    out_.is_whole = false;
    const std::size_t from = at_;
    Things of;
    for (; at_ < words_.size(); ++at_) of.merge(speak(at_));
    if (from < at_) out_.left.push_back({shown(from, at_), std::move(of), true});
  }

  Things speak(std::size_t at) {
    if (words_[at].is_slot) {
      out_.said.insert(words_[at].of.begin(), words_[at].of.end());
      return words_[at].of;
    }
    if (match(at).is == WordIs::kUnknown) out_.is_pure = false;
    Called::Found name = called_.find(texts(at, 5));
    out_.said.insert(name.of.begin(), name.of.end());
    return std::move(name.of);
  }

  const Called called_;
  const std::vector<Token> words_;
  std::size_t at_ = 0;
  Clauses out_;
  Things pending_;       // where the next clause goes, said before it
  bool unsure_ = false;  // a place that is no thing was said of the clause that is read
  bool joined_ = false;  // the words before are no part of a clause
  enum class Ordinal : std::uint8_t { kNone, kFirst, kLast } turn_ = Ordinal::kNone;
  Clause::Does last_ = Clause::Does::kOther;
};

}  // namespace

std::size_t number_of(std::string_view word) {
  constexpr auto kNumbers = std::to_array<std::string_view>(
      {"two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"});
  if (word == "both") return 2;
  const auto at = std::find(kNumbers.begin(), kNumbers.end(), word);
  return at == kNumbers.end() ? 0 : static_cast<std::size_t>(at - kNumbers.begin()) + 2;
}

std::size_t count_at_end(std::string_view text) {
  std::vector<Said::Word> words = words_in(text);
  const auto ends_with = [&](std::string_view word) {
    return !words.empty() && words.back().text == word && !words.back().ends;
  };
  while (ends_with("the")) words.pop_back();
  const bool is_some = ends_with("of");
  if (is_some) words.pop_back();
  if (words.empty() || words.back().ends) return 0;
  const std::size_t number = number_of(words.back().text);
  const bool is_all =
      words.back().text == "both" || (words.size() > 1 && words[words.size() - 2].text == "all");
  return is_some && !is_all ? 0 : number;
}

Clauses clauses_of(const Model& model, const Task& task, Callings& callings) {
  return ClauseReader(model, task, callings).run();
}

}  // namespace probe::sema
