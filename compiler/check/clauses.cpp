#include "compiler/check/clauses.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "compiler/check/called.h"
#include "compiler/check/clause_nouns.h"
#include "compiler/check/clause_words.h"
#include "runtime/base/check.h"

namespace probe::sema {
namespace {

// Reads clauses one after the other, each as far as it goes.
class ClauseReader : public ClauseNouns {
 public:
  using ClauseNouns::ClauseNouns;

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
      const bool is_but = word.is == WordIs::kBut && words_[at_].text == "but" && word.length == 1;
      const bool denies = word.is == WordIs::kDenies || (word.is == WordIs::kBut && !is_but);
      if (word.is == WordIs::kSpares || denies) {
        const bool is_inside = denies && at_ > 0 && !is_apart(at_);
        if (is_inside && !out_.all.empty()) doubt(out_.all.back(), at_);
        stop();
        break;
      }
      if (is_verb(word.is)) {
        clause(word);
      } else if (joins(word.is) || is_but || word.is == WordIs::kIdle || word.is == WordIs::kTurn) {
        joined_ = joined_ || joins(word.is) || is_but;
        at_ += word.length;
      } else if (!leading_place() && !same_again() && !turn() && !stated()) {
        unknown();
      }
      PROBE_CHECK(at_ > before, "a clause has words");
    }
    return std::move(out_);
  }

 private:
  // "Do not put the cup ..", "avoid putting it ..".
  bool denies_first(const Match& word) const {
    if (!out_.all.empty() || !is_verb(match(at_ + word.length).is)) return false;
    const std::string& text = words_[at_].text;
    return text == "not" || text == "don't" || text == "never" || text == "avoid" ||
           text == "refrain";
  }
  // Whether something stands between these words and those before them.
  bool is_apart(std::size_t at) const { return ends_at(at) || joined_; }

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
    covers_ = words_[from].text == "cover";
    finish(std::move(clause), from);
    covers_ = false;
    // What hangs on a hook is lower than it.
    Clause& read = out_.all.back();
    if (words_[from].text == "hang" && read.lies == Clause::Where::kOn)
      read.lies = Clause::Where::kElsewhere;
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
      // "Open the drawer and take the cup out".
      if (clause.does == Clause::Does::kTakes && words_[at_].text == "out") {
        for (const ObjectId id : out_.said) {
          if (called_.is_of_fixture(id)) clause.from.insert(id);
        }
        clause.begins_there = !clause.from.empty();
      }
      at_ += word.length;
      if (ends_at(at_)) return;
    }
  }

  // What stands behind the verb.
  void finish(Clause clause, std::size_t from) {
    turn_ = Ordinal::kNone;
    idle(clause);
    clause.is_none = match(at_).is == WordIs::kNone;
    clause.denied = clause.is_none;
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
      if (aside(clause)) continue;
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
      const bool is_but = next.is == WordIs::kBut && words_[at_].text == "but" && next.length == 1;
      const bool is_known =
          joins(next.is) || is_but || next.is == WordIs::kSpares || next.is == WordIs::kBegins;
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

  // "Put the cube, not the can, on the tray", "everything but the can", "all cubes except the red
  // one".
  bool aside(Clause& clause) {
    const Match word = match(at_);
    const bool is_not = word.is == WordIs::kDenies && words_[at_].text == "not";
    if (!is_not && word.is != WordIs::kBut) return false;
    const std::string& text = words_[at_].text;
    const bool excepts = text == "except" || (text == "but" && word.length == 1);
    const bool is_of_all = excepts && is_everything(clause);
    const auto other =
        is_of_all ? nouns(at_ + word.length, false) : but_what(at_ + word.length, clause);
    if (!other || other->is_place) return false;
    Things of;
    for (const Clause::What& one : other->what) of.insert(one.of.begin(), one.of.end());
    // "Put the cup on the tray but the can on the plate" goes on.
    if (excepts && !is_of_all && !is_several(clause, of)) return false;
    const std::size_t end = other->end;
    const WordIs next = match(end).is;
    if (is_of_all && clause.goes && is_place(next)) return false;
    const bool is_end = end == words_.size() || words_[end - 1].ends;
    if (!is_place(next) && next != WordIs::kDenies && next != WordIs::kBut &&
        (is_not || !(is_end || joins(next))))
      return false;
    if (excepts) {
      for (Clause::What& one : clause.what)
        std::erase_if(one.of, [&](ObjectId id) { return of.contains(id); });
    }
    clause.spared.insert(of.begin(), of.end());
    out_.said.insert(of.begin(), of.end());
    out_.left.push_back({shown(at_, end), std::move(of), true});
    at_ = end;
    return true;
  }
  static bool is_everything(const Clause& clause) {
    return clause.what.size() == 1 && clause.what[0].is_back && clause.what[0].is_each;
  }
  static bool is_several(const Clause& clause, const Things& but) {
    return std::any_of(clause.what.begin(), clause.what.end(), [&](const Clause::What& one) {
      return (one.is_each || one.is_several) && one.of.size() > but.size() &&
             std::includes(one.of.begin(), one.of.end(), but.begin(), but.end());
    });
  }
  // A noun, or "the red one" of those that were spoken of.
  std::optional<Noun> but_what(std::size_t at, const Clause& clause) {
    if (auto what = noun(at)) return what;
    while (match(at).is == WordIs::kThe) at += match(at).length;
    if (at + 1 >= words_.size() || words_[at + 1].text != "one") return std::nullopt;
    Noun found;
    found.end = at + 2;
    for (const Clause::What& one : clause.what) {
      if (Things of = called_.with(words_[at].text, one.of); !of.empty())
        found.what.push_back({std::move(of)});
    }
    out_.is_pure = false;
    return found.what.empty() ? std::nullopt : std::optional(std::move(found));
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
    if (word.is == WordIs::kFrom) clause.begins_there = words_[at].text != "away";
    // "Cover the cup with the plate" puts the plate on the cup.
    if (word.is == WordIs::kWith && covers_ && clause.what.size() == 1 && !clause.goes) {
      where = clause.what[0].of;
      clause.what = to->what;
      clause.lies = Clause::Where::kOn;
      clause.goes = true;
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
    if (word.is == WordIs::kBeside)
      return words_[at].text == "on" ? Clause::Where::kOnOrBeside : Clause::Where::kBeside;
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
    clause.is_kept = text == "keep";
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
    const bool is_all =
        at_ == 0 && is_place(is.is) && is.is != WordIs::kFrom && is.is != WordIs::kWith;
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
    for (; at_ < words_.size(); ++at_) {
      of.merge(speak(at_));
      // "Push the cup without lifting it".
      const bool is_it = match(at_).is == WordIs::kIt && words_[at_].text == "it";
      if (is_it && !out_.all.empty() && out_.all.back().what.size() == 1)
        of.insert(out_.all.back().what[0].of.begin(), out_.all.back().what[0].of.end());
    }
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

  std::size_t at_ = 0;
  Things pending_;       // where the next clause goes, said before it
  bool unsure_ = false;  // a place that is no thing was said of the clause that is read
  bool covers_ = false;  // the clause that is read says what is on top behind "with"
  bool joined_ = false;  // the words before are no part of a clause
  enum class Ordinal : std::uint8_t { kNone, kFirst, kLast } turn_ = Ordinal::kNone;
  Clause::Does last_ = Clause::Does::kOther;
};

}  // namespace

Clauses clauses_of(const Model& model, const Task& task, Callings& callings) {
  return ClauseReader(model, task, callings).run();
}

}  // namespace probe::sema
