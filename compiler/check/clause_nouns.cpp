#include "compiler/check/clause_nouns.h"

#include <algorithm>
#include <string>
#include <utility>

#include "compiler/check/count_words.h"

namespace probe::sema {

std::size_t ClauseNouns::before_noun(std::size_t at, Clause::What& how) const {
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
    const bool is_one =
        word.is == WordIs::kIt && text == "one" && called_.find(texts(at + 1, 4)).length > 0;
    if (word.is == WordIs::kNone) {
      at += word.length;
      continue;
    }
    if (text == "pair" && at + 1 < words_.size() && words_[at + 1].text == "of") {
      how.count = 2;
      at += 2;
      continue;
    }
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

std::optional<ClauseNouns::Noun> ClauseNouns::noun(std::size_t at) {
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
    found.what.push_back({out_.said, 0, true, false, words_[at].text == "everything"});
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
  if (name.length == 0 || words_[at].ends) return std::nullopt;
  out_.is_pure = false;
  if (auto other = called_.other_than(texts(at, 1 + name.length), name.of))
    out_.mistaken.push_back({*name.of.begin(), shown(at, at + 1 + name.length),
                             std::move(other->first), std::move(other->second)});
  if (name.of.size() != 1) return std::nullopt;
  found.what.push_back({name.of, 0, false});
  found.end = at + 1 + name.length;
  return found;
}

void ClauseNouns::of_what(Noun& found) {
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

std::optional<ClauseNouns::Noun> ClauseNouns::shared_noun(std::size_t at) {
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

std::optional<ClauseNouns::Noun> ClauseNouns::nouns(std::size_t at, bool is_where) {
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

void ClauseNouns::take_either(Noun& nouns) {
  Clause::What all;
  all.is_some = true;
  for (const Clause::What& one : nouns.what) all.of.insert(one.of.begin(), one.of.end());
  nouns.what = {std::move(all)};
}

void ClauseNouns::or_another(Noun& found) {
  const Match joint = match(found.end);
  const std::size_t at = found.end + joint.length;
  if (joint.is != WordIs::kOr || ends_at(found.end) || is_verb(match(at).is)) return;
  const auto other = noun(at);
  if (!other || other->is_place) return;
  found.end = other->end;
  found.what.insert(found.what.end(), other->what.begin(), other->what.end());
  take_either(found);
}

bool ClauseNouns::begins_again(std::size_t at) {
  const auto what = nouns(at, false);
  if (!what) return false;
  std::size_t next = what->end;
  while (match(next).is == WordIs::kIdle) next += match(next).length;
  return is_place(match(next).is) && !ends_at(next);
}

}  // namespace probe::sema
