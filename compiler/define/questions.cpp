// `questions`: families with their names resolved. What each asks of a task is ask.cpp.
#include <algorithm>

#include "compiler/define/define.h"
#include "compiler/define/expr.h"
#include "compiler/define/role.h"
#include "compiler/define/set.h"
#include "compiler/names/texts.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

constexpr std::uint32_t kUsualPixels = 64;

struct FamilyReader {
  Context& context;
  const Declared<syntax::QuestionsDecl>& declared;
  const syntax::QuestionStmt& stmt;
  Family& family;

  void read(SetReader& conditions) {
    family.name = std::string(stmt.name.text);
    family.span = stmt.name.span;
    check_name(context.diagnostics, stmt.name);
    family.form = stmt.form;
    family.moment = stmt.moment;
    family.text = stmt.text.text.value;
    family.text_span = stmt.text.text.span;
    check_text(context.diagnostics, spelled(stmt.text.text), "the question");
    if (is_blank(family.text))
      context.report(Situation::kNoWords, family.text_span,
                     "question `" + family.name + "` has no words");
    if (stmt.binder) family.over = read_pool(stmt.over);
    for (const syntax::QuestionPart& part : stmt.text.parts) read_part(part);
    family.answer.span = stmt.answer_span;
    std::visit(*this, stmt.answer);
    if (stmt.among) family.among = read_pool(*stmt.among);
    read_pixels();
    if (stmt.where && conditions.check_condition(*declared.file, *stmt.where))
      family.where = stmt.where->value;
  }

  void operator()(const syntax::AnswerOne& answer) {
    family.answer.kind = QuestionAnswer::kOne;
    add_who({&answer.who});
  }
  void operator()(const syntax::AnswerPresent& answer) {
    family.answer.kind = QuestionAnswer::kPresent;
    add_who({&answer.who});
  }
  void operator()(const syntax::AnswerBeside& answer) {
    family.answer.kind = answer.is_nearer ? QuestionAnswer::kNearer : QuestionAnswer::kLeft;
    add_who({&answer.a, &answer.b});
    check_different();
  }
  void operator()(const syntax::AnswerCount& answer) {
    family.answer.kind = QuestionAnswer::kCount;
    family.answer.attribute = attribute(answer.attribute);
    add_who({&answer.who});
  }
  void operator()(const syntax::AnswerMentions& answer) {
    family.answer.kind = QuestionAnswer::kMentions;
    add_who({&answer.what, &answer.to});
    check_different();
  }
  void operator()(const syntax::AnswerTruth& answer) {
    if (answer.expr.value == syntax::ExprId::kNone) return;  // a syntax error, reported
    const syntax::File& file = *declared.file;
    Metric& truth = family.answer.truth;
    if (const auto* name = std::get_if<syntax::ExprName>(&file[answer.expr].node)) {
      family.answer.kind = QuestionAnswer::kMetric;
      truth.name = std::string(name->name.text);
      truth.span = name->name.span;
      return;
    }
    family.answer.kind = QuestionAnswer::kCondition;
    if (const auto* call = std::get_if<syntax::ExprCall>(&file[answer.expr].node))
      family.answer.called = call->callee.text;
    truth.name = family.name;
    truth.span = family.span;
    truth.readout_span = stmt.answer_span;
    ExprReader reader(context, file);
    truth.expr = reader.condition(answer.expr);
    truth.variables = reader.variables();
    truth.type = context.model.exprs.nodes[truth.expr].type;
  }

 private:
  void read_pixels() {
    family.pixels = kUsualPixels;
    if (!stmt.pixels) return;
    constexpr std::uint64_t kMost = std::uint64_t{plan::kMaxPixels} * plan::kMaxPixels;
    if (stmt.pixels->value < 1 || stmt.pixels->value > kMost) {
      context.report(Situation::kQuestionPixels, stmt.pixels->span,
                     "expected between 1 and " + std::to_string(kMost) + " pixels");
      return;
    }
    family.pixels = static_cast<std::uint32_t>(stmt.pixels->value);
  }

  static QuestionPool read_pool(const syntax::ObjectPool& pool) {
    return {pool.is_catalogue, pool.absent ? pool.absent->value : 0};
  }

  void read_part(const syntax::QuestionPart& part) {
    if (const auto* literal = std::get_if<std::string>(&part)) {
      family.parts.push_back({*literal, std::nullopt});
      return;
    }
    const auto& written = std::get<syntax::Placeholder>(part);
    Placeholder out;
    out.span = written.span;
    out.article = static_cast<Placeholder::Article>(written.article);
    if (!written.what && written.of.text == "instruction" &&
        written.article == syntax::Placeholder::Article::kNone) {
      out.kind = Placeholder::kInstruction;
      family.parts.push_back({{}, std::move(out)});
      return;
    }
    const std::string_view what = written.what ? written.what->text : "name";
    out.kind = what == "name"     ? Placeholder::kName
               : what == "phrase" ? Placeholder::kPhrase
                                  : Placeholder::kAttribute;
    if (out.kind == Placeholder::kAttribute) out.attribute = attribute(*written.what);
    const auto found = who(written.of);
    if (!found) return;
    out.who = *found;
    family.parts.push_back({{}, std::move(out)});
  }

  // `category` is a word of the language (a slot may want one), so a catalogue without it only
  // leaves out what would be described by it.
  AttributeId attribute(const syntax::Name& name) {
    if (name.text == "category" && !context.symbols.attributes.peek(name.text))
      return AttributeId::kNone;
    const auto found = context.symbols.attributes.find(name, context.diagnostics);
    return found ? static_cast<AttributeId>(*found) : AttributeId::kNone;
  }

  std::optional<Who> who(const syntax::Name& name) {
    const auto is = [&](Who::Kind kind) {
      return Who{kind, ObjectId::kNone, std::string(name.text), name.span, RoleId::kNone};
    };
    if (name.text.empty()) return std::nullopt;  // a syntax error, reported
    if (stmt.binder && name.text == stmt.binder->text) return is(Who::kBound);
    if (name.text == "source") return is(Who::kSource);
    if (name.text == "target") return is(Who::kTarget);
    if (name.text == "avoided") return is(Who::kAvoided);
    if (find_role(context, name.text)) {
      const auto role = find_single_role(context, name);
      if (!role) return std::nullopt;
      Who out = is(Who::kRole);
      out.role = *role;
      return out;
    }
    if (const auto object = context.symbols.objects.peek(name.text)) {
      Who out = is(Who::kObject);
      out.object = static_cast<ObjectId>(*object);
      return out;
    }
    std::vector<std::string_view> roles = {"source", "target", "avoided", "instruction"};
    if (stmt.binder) roles.push_back(stmt.binder->text);
    if (nearest(name.text, roles)) {
      report_unknown(context.diagnostics, "role", name, roles);
    } else {
      context.symbols.objects.find(name, context.diagnostics);
    }
    return std::nullopt;
  }

  void add_who(std::initializer_list<const syntax::Name*> names) {
    for (const syntax::Name* name : names) {
      if (auto found = who(*name)) family.answer.who.push_back(std::move(*found));
    }
  }

  void check_different() {
    const auto& said = family.answer.who;
    if (said.size() == 2 && said[0] == said[1])
      context.report(Code::P0203, said[1].span, "`" + said[1].text + "` is named twice");
  }
};

// A choice is told by the instruction, or by a description of what is right.
void check_told(Context& context, const Family& family) {
  if (family.form != plan::QuestionForm::kChoice || family.answer.who.empty()) return;
  const Who& right = family.answer.who[0];
  for (const Family::Part& part : family.parts) {
    if (!part.placeholder) continue;
    const Placeholder& said = *part.placeholder;
    const bool describes =
        said.kind == Placeholder::kPhrase || said.kind == Placeholder::kAttribute;
    if (said.kind == Placeholder::kInstruction || (describes && said.who == right)) return;
  }
  context
      .report(
          Code::P0904, family.text_span,
          "nothing in question `" + family.name + "` tells that the answer is `" + right.text + "`")
      .help("say the `{instruction}`, or describe it: `{phrase of " + right.text + "}`");
}

// What lies somewhere at the start may have left the picture by the end, and metrics are read
// there.
void check_moment(Context& context, const Family& family) {
  if (family.answer.kind == QuestionAnswer::kMetric &&
      family.moment == plan::QuestionMoment::kStart) {
    context
        .report(Code::P0904, family.answer.span,
                "`" + family.answer.truth.name +
                    "` is no condition of the start; metrics are read at the end of an episode")
        .help(
            "answer `present(source)`, `left(source, target)` or a condition such as "
            "`closed(target)`, or ask `at end`");
    return;
  }
  const bool is_place = family.answer.kind == QuestionAnswer::kPresent ||
                        family.answer.kind == QuestionAnswer::kCount;
  if (!is_place || family.moment != plan::QuestionMoment::kEnd) return;
  context.report(Code::P0904, family.answer.span,
                 "the text proves what is there at the start, not at the end");
}

// The words between two names, where a question says which side the first is on.
struct SideWords {
  std::string_view words;
  QuestionAnswer::Kind kind;
  bool is_first;  // of the first name, as the answer has it; else of the second
};
constexpr SideWords kSideWords[] = {
    {"left of", QuestionAnswer::kLeft, true},
    {"right of", QuestionAnswer::kLeft, false},
    {"nearer to the camera than", QuestionAnswer::kNearer, true},
    {"closer to the camera than", QuestionAnswer::kNearer, true},
    {"nearer than", QuestionAnswer::kNearer, true},
    {"closer than", QuestionAnswer::kNearer, true},
    {"in front of", QuestionAnswer::kNearer, true},
    {"further from the camera than", QuestionAnswer::kNearer, false},
    {"farther from the camera than", QuestionAnswer::kNearer, false},
    {"further away than", QuestionAnswer::kNearer, false},
    {"farther away than", QuestionAnswer::kNearer, false},
    {"further than", QuestionAnswer::kNearer, false},
    {"farther than", QuestionAnswer::kNearer, false},
    {"behind", QuestionAnswer::kNearer, false},
};

// "Is X to the left of Y?" with the answer left(Y, X): every answer would be read the wrong way
// round. Words that are put otherwise, or deny, are the author's own.
void check_sides(Context& context, const Family& family) {
  const auto& who = family.answer.who;
  if (who.size() != 2) return;
  std::vector<const Placeholder*> said;
  std::string between;
  for (const Family::Part& part : family.parts) {
    if (part.placeholder) {
      said.push_back(&*part.placeholder);
    } else if (said.size() == 1) {
      between += fold_case(part.literal);
    } else if (has_words(fold_case(part.literal), "not")) {
      return;
    }
  }
  if (said.size() != 2 || has_words(between, "not")) return;
  for (const SideWords& side : kSideWords) {
    if (side.kind != family.answer.kind || !has_words(between, side.words)) continue;
    const Who& first = side.is_first ? who[0] : who[1];
    const Who& second = side.is_first ? who[1] : who[0];
    if (!(said[0]->who == second) || !(said[1]->who == first)) continue;
    context
        .report(Code::P0904, family.answer.span,
                "question `" + family.name + "` says \"" + std::string(side.words) + "\" with `" +
                    said[0]->who.text + "` and `" + said[1]->who.text + "` the other way round")
        .help("exchange `" + who[0].text + "` and `" + who[1].text + "` in the answer");
  }
}

// Words with which a question asks for the opposite of an answer, or for another role.
struct TurnedWords {
  std::string_view words;
  bool (*turns)(const QuestionAnswer& answer);
};
bool asks_of_presence(const QuestionAnswer& answer) {
  return answer.kind == QuestionAnswer::kPresent;
}
bool asks_of_success(const QuestionAnswer& answer) {
  return answer.kind == QuestionAnswer::kMetric && answer.truth.name == "success";
}
bool asks_for_source(const QuestionAnswer& answer) {
  return answer.kind == QuestionAnswer::kOne && answer.who.size() == 1 &&
         answer.who[0].kind == Who::kSource;
}
bool asks_of_opened(const QuestionAnswer& answer) { return answer.called == "opened"; }
bool asks_of_closed(const QuestionAnswer& answer) { return answer.called == "closed"; }
constexpr TurnedWords kTurnedWords[] = {
    {"closed", asks_of_opened},      {"shut", asks_of_opened},
    {"open", asks_of_closed},        {"not", asks_of_opened},
    {"not", asks_of_closed},         {"absent", asks_of_presence},
    {"missing", asks_of_presence},   {"not", asks_of_presence},
    {"no longer", asks_of_presence}, {"gone", asks_of_presence},
    {"fail", asks_of_success},       {"fails", asks_of_success},
    {"failed", asks_of_success},     {"not", asks_of_success},
    {"not touch", asks_for_source},  {"not pick", asks_for_source},
    {"not take", asks_for_source},   {"not move", asks_for_source},
    {"avoid", asks_for_source},      {"leave alone", asks_for_source},
    {"where", asks_for_source},
};

// "Is X missing?" with the answer present(X): right answers would be judged wrong. So a point at
// another object than the answer's.
void check_turned(Context& context, const Family& family) {
  std::string text;
  std::vector<const Placeholder*> said;
  for (const Family::Part& part : family.parts) {
    text += part.placeholder ? " " : fold_case(part.literal);
    if (part.placeholder) said.push_back(&*part.placeholder);
  }
  // "Is it there or not?" asks both ways.
  const bool asks_both = has_words(text, "or not");
  for (const TurnedWords& turned : kTurnedWords) {
    if (asks_both || !turned.turns(family.answer) || !has_words(text, turned.words)) continue;
    // A point is asked for where something is.
    if (turned.words == "where" && family.form == plan::QuestionForm::kPoint) continue;
    context
        .report(Code::P0904, family.answer.span,
                "question `" + family.name + "` says \"" + std::string(turned.words) +
                    "\", and its answer is the other one")
        .help("ask for the answer itself, or declare the one that is asked for");
    return;
  }
  if (family.form != plan::QuestionForm::kPoint || family.answer.who.size() != 1) return;
  if (said.size() != 1 || said[0]->kind == Placeholder::kInstruction ||
      said[0]->who == family.answer.who[0])
    return;
  // An object by its name may be who fills the role.
  const auto is_role = [&](const Who& who) { return find_role(context, who.text).has_value(); };
  if (is_role(said[0]->who) != is_role(family.answer.who[0])) return;
  context
      .report(Code::P0904, family.answer.span,
              "question `" + family.name + "` speaks of `" + said[0]->who.text +
                  "`, and its answer is `" + family.answer.who[0].text + "`")
      .help("answer `" + said[0]->who.text + "`");
}

}  // namespace

void define_questions(Context& context) {
  if (context.symbols.question_decls.empty()) return;
  SetReader conditions(context, SetReader::Mode::kDefined);
  for (const auto& declared : context.symbols.question_decls) {
    QuestionSet set;
    set.name = std::string(declared.node->name.text);
    set.span = declared.node->name.span;
    set.decl_span = declared.decl->span;
    set.file = declared.file;
    check_name(context.diagnostics, declared.node->name);
    for (const syntax::Allow& allow : declared.decl->allows) {
      const auto code = code_from_slug(allow.what.text);
      set.allow_ambiguous = set.allow_ambiguous || code == Code::P0901;
      set.allow_same = set.allow_same || code == Code::P0902;
    }
    const About about(context.reporter, set.decl_span);
    for (const syntax::QuestionStmt& stmt : declared.node->body) {
      const auto same = std::find_if(set.families.begin(), set.families.end(),
                                     [&](const Family& f) { return f.name == stmt.name.text; });
      if (same != set.families.end()) {
        context
            .report(Code::P0203, stmt.name.span, "question `" + same->name + "` is declared twice")
            .label(same->span, "first here");
        continue;
      }
      Family family;
      const std::size_t mistakes = context.mistakes();
      FamilyReader{context, declared, stmt, family}.read(conditions);
      family.broken = !declared.decl->complete || context.mistakes() != mistakes;
      if (!family.broken) {
        check_told(context, family);
        check_moment(context, family);
        check_sides(context, family);
        check_turned(context, family);
      }
      set.families.push_back(std::move(family));
    }
    if (declared.decl->complete && set.families.empty())
      context.report(Situation::kStatementMissing, set.span,
                     "set of questions `" + set.name + "` asks nothing");
    context.model.question_sets.add(std::move(set));
  }
}

}  // namespace probe::sema
