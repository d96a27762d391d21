#include "runtime/ask/reading/mentions.h"

#include <algorithm>
#include <array>

#include "runtime/ask/reading/read_rules.h"

namespace probe::ask {
namespace {

constexpr auto kGoalWords =
    std::to_array<std::string_view>({"on", "onto", "in", "into", "inside", "upon", "atop", "over"});
// Words of other places than on or in what follows them.
constexpr auto kElsewhere = std::to_array<std::string_view>(
    {"under", "underneath", "above",   "below",  "beneath", "beside", "besides",
     "by",    "near",       "behind",  "left",   "right",   "front",  "next",
     "close", "toward",     "towards", "around", "against", "off",    "away"});
constexpr auto kStops = std::to_array<std::string_view>(
    {"remove", "removes", "removing", "stop", "stops", "prevent", "prevents", "refuse", "refuses",
     "refrain", "forbid", "forbidden", "decline", "fail", "fails", "nothing", "wrong"});
// Of the task's frame: what brings one thing to another. Picking up alone does not.
constexpr auto kPuts = std::to_array<std::string_view>(
    {"put",       "puts",      "putting",     "place",    "places",    "placing",   "placed",
     "move",      "moves",     "moving",      "moved",    "set",       "sets",      "setting",
     "drop",      "drops",     "dropping",    "dropped",  "bring",     "brings",    "brought",
     "transfer",  "transfers", "transferred", "push",     "pushes",    "pushed",    "lay",
     "lays",      "laid",      "deposit",     "deposits", "deposited", "relocate",  "relocates",
     "relocated", "carry",     "carries",     "carried",  "position",  "positions", "positioned",
     "drag",      "drags",     "get",         "gets",     "stack",     "stacks",    "stacking",
     "stacked",   "slide",     "slides",      "slid",     "insert",    "inserts",   "pour",
     "goes",      "go",        "belongs",     "end",      "ends",      "hold",      "holds",
     "contain",   "contains",  "receive",     "receives", "support",   "supports",  "has",
     "have",      "transport", "release",     "releases"});
constexpr auto kNotThere =
    std::to_array<std::string_view>({"anywhere but", "anywhere else", "anything but",
                                     "anything other", "other than", "else than", "other side"});
// What a hand does when the thing is where it belongs.
constexpr auto kLetsGo =
    std::to_array<std::string_view>({"release", "let", "open", "withdraw", "retreat", "stop"});
constexpr auto kLies = std::to_array<std::string_view>(
    {"is", "are", "was", "lies", "sits", "stands", "rests", "lying", "sitting", "resting"});
constexpr auto kMoves = std::to_array<std::string_view>(
    {"pick",     "picks",     "picking",  "put",     "puts",     "putting",   "place",   "places",
     "placing",  "move",      "moves",    "moving",  "take",     "takes",     "taking",  "grab",
     "grabs",    "grasp",     "grasps",   "lift",    "lifts",    "stack",     "stacks",  "stacking",
     "drop",     "drops",     "dropping", "set",     "sets",     "setting",   "bring",   "brings",
     "transfer", "transfers", "push",     "pushes",  "lay",      "lays",      "deposit", "deposits",
     "relocate", "relocates", "carry",    "carries", "position", "positions", "drag",    "get"});
constexpr auto kHolds =
    std::to_array<std::string_view>({"hold", "holds", "contain", "contains", "receive", "receives",
                                     "support", "supports", "has", "have"});
constexpr auto kLeftAlone = std::to_array<std::string_view>(
    {"alone", "untouched", "ignored", "avoided", "excluded", "unused"});
constexpr auto kAreNot = std::to_array<std::string_view>({"is", "are", "should", "must", "be"});
constexpr auto kClauseEnds = std::to_array<std::string_view>({"but", "while", "whereas"});

// What an instruction is held together by; neither verbs nor nouns.
constexpr auto kFunctionWords = std::to_array<std::string_view>(
    {"on",   "onto",  "in",    "into", "inside", "to",    "of",   "off",  "from",  "at",
     "with", "for",   "by",    "and",  "or",     "not",   "it",   "its",  "is",    "are",
     "be",   "up",    "down",  "out",  "this",   "that",  "they", "them", "when",  "where",
     "one",  "which", "there", "then", "so",     "as",    "but",  "over", "under", "near",
     "next", "top",   "you",   "your", "please", "could", "do",   "no"});

template <typename Table, typename Word>
bool has_word(const Table& table, const Word& word) {
  return std::find(table.begin(), table.end(), word) != table.end();
}

bool ends_clause(const Token& token) {
  constexpr std::string_view kSigns = ",;:()-";
  if (token.kind == TokenKind::kSign && token.text.size() == 1 &&
      kSigns.find(token.text[0]) != kSigns.npos)
    return true;
  return token.is_end() || (token.is_word() && has_word(kClauseEnds, token.text));
}

// What the words right before a name, back to the name before it, say of it.
MentionRole role_before(const Tokens& tokens, const Named& name, std::size_t last) {
  constexpr int kFar = 4;  // words, without articles: "on top of the yellow"
  int words = 0;
  for (std::size_t at = name.begin; at > last && words < kFar;) {
    const Token& token = tokens[--at];
    if (token.is("\u2192")) return MentionRole::kGoal;
    if (ends_clause(token)) break;
    if (!token.is_word() || is_article(token.text)) continue;
    ++words;
    // "to pick up the carrot" has no place behind its "to".
    const bool leads = at + 1 == name.begin || is_article(tokens[at + 1].text);
    if (has_word(kElsewhere, token.text)) return MentionRole::kUnmarked;
    const bool nears = at > 0 && (tokens[at - 1].is("next") || tokens[at - 1].is("close"));
    if (token.is("to") && nears) return MentionRole::kUnmarked;
    if (has_word(kGoalWords, token.text) || (token.is("to") && leads)) return MentionRole::kGoal;
    if (token.is("from")) return MentionRole::kAside;
    if (has_word(kMoves, token.text)) return MentionRole::kMoved;
  }
  return MentionRole::kUnmarked;
}

// What the words behind it, up to `next` or the end of its clause, say.
MentionRole role_behind(const Tokens& tokens, const Named& name, std::size_t next, bool is_last) {
  for (std::size_t at = name.end; at < next && !ends_clause(tokens[at]); ++at) {
    const Token& token = tokens[at];
    if (has_word(kLeftAlone, token.text)) return MentionRole::kAvoided;
    if (at == name.end && has_word(kAreNot, token.text)) {
      for (std::size_t i = at + 1; i < next && i < at + 3; ++i) {
        if (tokens[i].is("not")) return MentionRole::kAvoided;
      }
    }
    const bool helps =
        at + 1 < tokens.size() && (tokens[at + 1].is("to") || tokens[at + 1].is("been"));
    if (!is_last && has_word(kHolds, token.text) && !helps) return MentionRole::kGoal;
  }
  return MentionRole::kUnmarked;
}

// "the carrot and the cup", of which nobody knows the cup; "the plate's box".
bool names_more(const RestateContext& context, std::string_view text, const Tokens& tokens,
                const std::vector<Named>& named) {
  constexpr auto kOfItself = std::to_array<std::string_view>(
      {"surface", "top", "center", "centre", "middle", "inside", "interior", "edge", "rim"});
  for (std::size_t i = 0; i < named.size(); ++i) {
    const std::size_t end = named[i].end;
    const std::uint32_t option = context.options[named[i].place].option;
    if (end >= tokens.size() || !tokens[end].is_word()) continue;
    const Token& last = tokens[end - 1];
    const bool owns = text.substr(last.begin, last.end - last.begin).find('\'') != text.npos;
    if (owns && !has_word(kOfItself, tokens[end].text)) return true;
    const bool joins = option == context.source && tokens[end].is("and") &&
                       end + 2 < tokens.size() && is_article(tokens[end + 1].text);
    const bool known = i + 1 < named.size() && named[i + 1].begin == end + 2;
    if (joins && !known) return true;
  }
  return false;
}

// What the answer does with the mentions that is no restating, though their roles would do: it says
// where something lies, stops the task, or goes on to a second place. Empty: none of it.
std::string_view why_else(const RestateContext& context, std::string_view text,
                          const Tokens& tokens, const std::vector<Named>& named,
                          const std::vector<MentionRole>& roles) {
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const Token& token = tokens[at];
    if (token.is_word() && has_word(kStops, token.text)) return "it says what not to do";
    if (token.is_sign('?')) return "it asks";
    if (token.is("or") && !is_denied(tokens, at)) return "it leaves a choice";
  }
  if (names_more(context, text, tokens, named)) return "it mentions another object";
  if (context.target && has_phrase(tokens, kNotThere)) return "it names another place";
  // "Carrot on plate" has no other words, "a picture of a carrot on a plate" has.
  bool puts = !context.target, talks = false;
  for (std::size_t at = 0, name = 0; at < tokens.size(); ++at) {
    while (name < named.size() && named[name].end <= at) ++name;
    if (name < named.size() && named[name].begin <= at) continue;
    const Token& token = tokens[at];
    puts = puts || (token.is_word() && has_word(kPuts, token.text));
    talks = talks || (token.is_word() && !is_article(token.text) && !token.is("to") &&
                      !has_word(kGoalWords, token.text) && !token.is("top") && !token.is("of"));
  }
  if (talks && !puts) return "it does not say to put it there";
  std::size_t goal_end = 0, source_end = 0;
  bool is_over = false;
  for (std::size_t i = 0; i < named.size(); ++i) {
    const std::uint32_t option = context.options[named[i].place].option;
    const std::size_t end = named[i].end;
    if (option == context.target && roles[i] == MentionRole::kGoal) {
      goal_end = end;
      std::size_t before = named[i].begin;
      while (before > 0 && is_article(tokens[before - 1].text)) --before;
      is_over = before > 0 && tokens[before - 1].is("over");
    }
    if (option == context.source) source_end = end;
    if (option != context.source || end + 1 >= tokens.size()) continue;
    const std::size_t verb = tokens[end].is("that") || tokens[end].is("which") ? end + 1 : end;
    const bool lies = has_word(kLies, tokens[verb].text) && verb + 1 < tokens.size() &&
                      has_word(kGoalWords, tokens[verb + 1].text);
    // "The carrot is on the left. Put it on the plate." goes on.
    constexpr std::size_t kFar = 6;  // tokens: "that lies on top of the plate"
    const bool on_goal = i + 1 < named.size() && named[i + 1].begin <= verb + kFar &&
                         context.options[named[i + 1].place].option == context.target;
    if (lies && on_goal) return "it says where what is moved lies";
  }
  for (std::size_t at = goal_end; goal_end > 0 && at < tokens.size(); ++at) {
    const bool joined = at == goal_end && tokens[at].is("and") && at + 1 < tokens.size() &&
                        has_word(kGoalWords, tokens[at + 1].text);
    const bool lets_go = at + 1 < tokens.size() && has_word(kLetsGo, tokens[at + 1].text);
    const bool crosses = is_over && at == goal_end &&
                         (tokens[at].is("to") || tokens[at].is("onto") || tokens[at].is("into"));
    const bool again = at >= source_end && tokens[at].is_word() &&
                       (has_word(kMoves, tokens[at].text) || tokens[at].is("back")) &&
                       !is_denied(tokens, at);
    if ((tokens[at].is("then") && !lets_go) || tokens[at].is("afterwards") || joined || crosses ||
        again)
      return "it goes on to another place";
  }
  return {};
}

// By clause: [begin of its first token, its names).
struct Clause {
  std::size_t begin = 0, end = 0;
  std::vector<std::size_t> names;
};

std::vector<Clause> clauses_of(const Tokens& tokens, const std::vector<Named>& named) {
  std::vector<Clause> out(1);
  std::size_t name = 0;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    while (name < named.size() && named[name].begin == at) out.back().names.push_back(name++);
    if (!ends_clause(tokens[at])) continue;
    out.back().end = at;
    out.push_back({at + 1, 0, {}});
  }
  out.back().end = tokens.size();
  return out;
}

std::vector<MentionRole> roles_of(const RestateContext& context, const Tokens& tokens,
                                  const std::vector<Named>& named) {
  std::vector<MentionRole> roles(named.size());
  const auto is_meant = [&](std::size_t name) {
    const std::uint32_t option = context.options[named[name].place].option;
    return option == context.source || option == context.target;
  };
  for (const Clause& clause : clauses_of(tokens, named)) {
    bool denies_other = false;
    std::size_t begin = clause.begin, looked = clause.begin;
    for (std::size_t i = 0; i < clause.names.size(); ++i) {
      const Named& name = named[clause.names[i]];
      const bool is_last = i + 1 == clause.names.size();
      const std::size_t before = i == 0 ? clause.begin : named[clause.names[i - 1]].end;
      const std::size_t next = is_last ? clause.end : named[clause.names[i + 1]].begin;
      MentionRole role = role_before(tokens, name, before);
      if (role == MentionRole::kUnmarked || role == MentionRole::kMoved) {
        const MentionRole behind = role_behind(tokens, name, next, is_last);
        if (behind != MentionRole::kUnmarked) role = behind;
      }
      // "without touching the towel and place it on the plate" begins another one.
      for (; looked + 1 < name.begin; ++looked) {
        if (tokens[looked].is("and") && has_word(kMoves, tokens[looked + 1].text))
          begin = looked + 1;
      }
      const auto clause_tokens = std::span(tokens).subspan(begin);
      if (is_denied(clause_tokens, name.begin - begin)) role = MentionRole::kAvoided;
      denies_other = denies_other || (role == MentionRole::kAvoided && !is_meant(clause.names[i]));
      roles[clause.names[i]] = role;
    }
    // "Do not put the carrot on the towel" is about the towel.
    for (const std::size_t name : clause.names) {
      if (denies_other && is_meant(name) && roles[name] == MentionRole::kAvoided)
        roles[name] = MentionRole::kAside;
    }
  }
  return roles;
}

bool has_noun(const std::vector<std::string>& words, std::string_view word) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& one) { return is_same_noun(one, word); });
}

const ShownOption* option_at(const RestateContext& context, std::optional<std::uint32_t> option) {
  if (!option) return nullptr;
  for (const ShownOption& one : context.options) {
    if (one.option == *option) return &one;
  }
  return nullptr;
}

std::string_view why_wrong(const RestateContext& context, const std::vector<Mention>& mentions,
                           const std::vector<std::uint32_t>& named_by_instruction) {
  bool source = !context.source, target = !context.target;
  bool source_phrase = false, target_phrase = false;
  for (const Mention& mention : mentions) {
    const bool is_source = mention.option == context.source;
    const bool is_target = mention.option == context.target;
    const bool avoided = mention.role == MentionRole::kAvoided;
    if (!is_source && !is_target) {
      if (!avoided) return "it mentions another object";
      continue;
    }
    if (avoided) return "it avoids what is meant";
    const bool counts =
        mention.words == MentionWords::kPlain || has_word(named_by_instruction, mention.option);
    if (is_source) {
      if (mention.role == MentionRole::kGoal) return "it takes what is moved for the goal";
      if (mention.role == MentionRole::kAside) continue;
      (counts ? source : source_phrase) = true;
    } else {
      if (mention.role == MentionRole::kMoved) return "it takes the goal for what is moved";
      if (mention.role != MentionRole::kGoal) continue;
      (counts ? target : target_phrase) = true;
    }
  }
  if (!source)
    return source_phrase ? "it does not name what is moved, only describes it"
                         : "it does not mention what is moved";
  if (!target)
    return target_phrase ? "it does not name the goal, only describes it"
                         : "it does not mention the goal";
  return {};
}

}  // namespace

std::string_view word_of(MentionRole role) {
  constexpr std::string_view kWords[] = {"unmarked", "moved", "goal", "avoided", "aside"};
  return kWords[static_cast<std::size_t>(role)];
}

std::string_view word_of(MentionWords words) {
  constexpr std::string_view kWords[] = {"plain", "instruction's", "other"};
  return kWords[static_cast<std::size_t>(words)];
}

double share_copied(const RestateContext& context, std::string_view answer) {
  const std::vector<std::string> all = plain_words(context.instruction);
  std::vector<std::string> names;
  for (const auto& option : {context.source, context.target}) {
    const ShownOption* one = option_at(context, option);
    if (one == nullptr) continue;
    for (std::string& word : plain_words(one->name)) names.push_back(std::move(word));
  }
  std::vector<std::string> own;
  for (const std::string& word : all) {
    const bool counts = !has_word(kFunctionWords, word) && !has_noun(names, word);
    if (counts && !has_word(own, word)) own.push_back(word);
  }
  if (own.empty()) {
    for (const std::string& word : all) {
      if (!has_word(own, word)) own.push_back(word);
    }
  }
  if (own.empty()) return 0;
  const std::vector<std::string> said = plain_words(answer);
  const auto repeated = std::count_if(
      own.begin(), own.end(), [&](const std::string& word) { return has_noun(said, word); });
  return static_cast<double>(repeated) / static_cast<double>(own.size());
}

Restatement restate(const RestateContext& context, std::string_view raw, std::string_view finish) {
  const ReadContext read{.form = plan::QuestionForm::kFree,
                         .options = {context.options.begin(), context.options.end()}};
  Restatement out;
  out.reading = read_answer(read, raw, finish);
  if (out.reading.verdict != Verdict::kRead) return out;
  const std::string text = free_part(raw);
  const Tokens tokens = tokens_of(text);
  const NameTable names(context.options);
  const std::vector<Named> named = names.find(tokens);
  const std::vector<std::string> instruction = plain_words(context.instruction);
  const auto roles = roles_of(context, tokens, named);
  for (std::size_t i = 0; i < named.size(); ++i) {
    const ShownOption& option = context.options[named[i].place];
    MentionWords words = MentionWords::kPlain;
    if (named[i].word > 0) {
      const bool own = stands_in(plain_words(option.words[named[i].word - 1]), instruction);
      words = own ? MentionWords::kInstruction : MentionWords::kOther;
    }
    out.mentions.push_back({option.option, roles[i], words});
  }
  std::vector<std::uint32_t> named_by_instruction;
  const Tokens asked = tokens_of(plain_form(context.instruction));
  for (const Named& name : names.find(asked)) {
    if (name.word == 0) named_by_instruction.push_back(context.options[name.place].option);
  }
  out.wrong_by = why_wrong(context, out.mentions, named_by_instruction);
  if (out.wrong_by.empty()) out.wrong_by = why_else(context, text, tokens, named, roles);
  out.right = out.wrong_by.empty();
  out.copied = share_copied(context, text);
  return out;
}

}  // namespace probe::ask
