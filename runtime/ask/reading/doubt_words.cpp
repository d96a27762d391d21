#include "runtime/ask/reading/doubt_words.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

namespace probe::ask {
namespace {

struct Row {
  Against kind;
  std::string_view phrases;  // between commas; folded and without apostrophes
};

constexpr Row kAgainst[] = {
    {Against::kDenies,
     "not, no, never, nt, isnt, arent, wasnt, werent, dont, doesnt, didnt, cant, cannot, "
     "couldnt, shouldnt, mustnt, wont, wouldnt, hasnt, havent, hardly, neither, nor, none, "
     "nobody, nothing, nope, without, except, unlike, rather, instead, besides, other than, "
     "anything but, anywhere but, all but, everything but, fail to, fails to"},
    // Of other languages, where a plain answer may stand beside them.
    {Against::kDenies,
     "nicht, kein, keine, nein, pas, ne, non, niet, nunca, n\u00e3o, nao, \u043d\u0435, "
     "\u043d\u0435\u0442, \u4e0d, \u4e0d\u662f, \u5426, \u6ca1\u6709"},
    {Against::kRejects,
     "wrong, wrongly, incorrect, incorrectly, false, falsch, faux, incorrecto, worst, worse, "
     "bad, least, unlikely, implausible, forbidden, irrelevant, distractor, distract, "
     "distracts, trap, mistake, error, lie, fails, lacks, opposite, eliminate, eliminated, "
     "eliminating, exclude, excluded, excluding, rule, ruled, ruling, reject, rejected, "
     "discard, discarded, dismiss, dismissed, forget, cross out, crossed, ignore, ignoring, "
     "ignored, skip, skipping, avoid, avoiding, avoided, refuse, refuses, alone, untouched, "
     "missing, absent"},
    {Against::kDoubts,
     "doubt, doubtful, maybe, perhaps, possibly, might, could, unsure, uncertain, unclear, "
     "guess, if, unless, whether, tempting, plausible, at first, first glance, first sight, "
     "first thought, my first, something like, well enough"},
    {Against::kTurns,
     "however, but, wait, oops, hmm, hm, actually, correction, scratch, i mean, i meant, on "
     "reflection, second thought, looking closer, look again, looking again, reconsider, "
     "reconsidering"},
};

// Phrases with such a word that deny nothing.
constexpr auto kHarmless = std::to_array<std::string_view>(
    {"cannot be sure", "cant be sure", "no doubt about it", "not only", "no other", "or not"});

constexpr auto kStrikingSigns = std::to_array<std::string_view>(
    {"\u274c", "\u2717", "\u2718",     "\u2715",     "\u2716",    "\u2612",    "\u2610", "\u2260",
     "!=",     "\u00ac", "\U0001f6ab", "\U0001f44e", "\u26d4",    "[ ]",       "\\neq",  "\\ne ",
     "\\neg",  "\\not",  "\\lnot",     "\\cancel",   "\\xcancel", "\\bcancel", "\\sout", "\\st{",
     "~~",     "<s>",    "<del",       "<strike",    "\u0338",    "\u0336"});

// What plain sentences that answer are made of beside the words of question and options.
constexpr std::string_view kPlainWords =
    "i, id, im, would, should, must, has, have, had, will, can, needs, need, needed, say, "
    "think, believe, choose, chose, select, selected, pick, picks, picked, picking, up, take, "
    "takes, taken, grab, grasp, grasped, lift, lifts, move, moved, moves, get, put, place, "
    "placed, go, with, for, it, its, is, are, was, be, been, the, a, an, this, that, these, "
    "those, which, what, whose, of, to, on, onto, in, into, at, by, as, from, and, s, robot, "
    "robots, arm, gripper, object, objects, option, options, letter, choice, answer, answers, "
    "response, solution, item, items, one, label, correct, right, best, final, most, likely, "
    "meant, asked, named, described, mentioned, fits, matches, shown, called, picture, image, "
    "scene, photo, table, instruction, task, so, thus, hence, therefore, clearly, obviously, "
    "certainly, definitely, course, sure, my, me, let, based, according, here, please, "
    "assistant, only, closest, nearest, just, exactly, question, single, la, le, respuesta, "
    "es, die, der, das, antwort, ist, est, r\u00e9ponse, \U0001f449, \u7b54\u6848, "
    "\u043e\u0442\u0432\u0435\u0442";

// The phrases of a list between commas.
std::vector<std::string_view> phrases_of(std::string_view list) {
  std::vector<std::string_view> phrases;
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t end = std::min(list.find(", ", at), list.size());
    phrases.push_back(list.substr(at, end - at));
    at = end + 2;
  }
  return phrases;
}

struct Phrase {
  Against kind;
  std::string_view words;
};

// By their first word.
const std::multimap<std::string_view, Phrase>& phrases_by_word() {
  static const auto kPhrases = [] {
    std::multimap<std::string_view, Phrase> phrases;
    for (const Row& row : kAgainst) {
      for (const std::string_view words : phrases_of(row.phrases))
        phrases.emplace(words.substr(0, words.find(' ')), Phrase{row.kind, words});
    }
    return phrases;
  }();
  return kPhrases;
}

}  // namespace

// From the word itself or the one before it on.
bool is_harmless(std::span<const Token> tokens, std::size_t at) {
  return std::ranges::any_of(kHarmless, [&](std::string_view phrase) {
    return stands_phrase(tokens, at, phrase) ||
           (at > 0 && !stands_phrase(tokens, at, phrase.substr(0, phrase.find(' '))) &&
            stands_phrase(tokens, at - 1, phrase));
  });
}

bool is_against(std::span<const Token> tokens, std::size_t at, std::span<const Against> kinds) {
  if (!tokens[at].is_word()) return false;
  const auto [first, end] = phrases_by_word().equal_range(tokens[at].text);
  const bool stands = std::any_of(first, end, [&](const auto& entry) {
    return std::ranges::find(kinds, entry.second.kind) != kinds.end() &&
           stands_phrase(tokens, at, entry.second.words);
  });
  return stands && !is_harmless(tokens, at);
}

bool has_against(std::span<const Token> tokens, std::span<const Against> kinds) {
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (is_against(tokens, at, kinds)) return true;
  }
  return false;
}

bool has_against(std::span<const Token> tokens) {
  return has_against(tokens, kSaysNot) || has_against(tokens, kTakesBack);
}

bool has_striking_sign(std::string_view text) {
  return std::ranges::any_of(kStrikingSigns,
                             [&](std::string_view sign) { return text.find(sign) != text.npos; });
}

bool is_plain_word(std::string_view word) {
  static const auto kWords = [] {
    const auto words = phrases_of(kPlainWords);
    return std::set<std::string_view>(words.begin(), words.end());
  }();
  return kWords.contains(word);
}

}  // namespace probe::ask
