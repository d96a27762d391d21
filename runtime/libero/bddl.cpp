#include "runtime/libero/bddl.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <span>

#include "runtime/base/printable.h"
#include "runtime/base/spelling.h"

namespace probe::libero {
namespace {

struct PredicateRow {
  std::string_view word;
  std::size_t arguments;
};
constexpr PredicateRow kPredicates[] = {
#define LIBERO_PREDICATE(word, arguments, skill, when) {#word, arguments},
#include "runtime/libero/predicates.def"
#undef LIBERO_PREDICATE
};

constexpr std::size_t kLongestShown = 60;

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

template <typename Rows>
std::vector<std::string_view> words_of(const Rows& rows) {
  std::vector<std::string_view> words;
  for (const auto& row : rows) words.push_back(row.word);
  return words;
}

class BddlReader {
 public:
  explicit BddlReader(BddlRead& read) : read_(read), problem_(read.problem) {}

  void read(std::string_view text) {
    auto read = read_sexpr(text, problem_.path);
    if (!read) {
      read_.mistakes.push_back(read.failure());
      return;
    }
    tree_ = std::move(*read);
    read_define(tree_.top());
    std::ranges::stable_sort(mistakes_, {}, &Mistake::spot);
    for (Mistake& mistake : mistakes_) {
      read_.mistakes.push_back(
          {Fault::kUsage, std::move(mistake.what), place_of(problem_.path, mistake.spot)});
    }
  }

 private:
  struct Mistake {
    Spot spot;
    std::string what;
  };
  struct SectionRow {
    std::string_view word;
    void (BddlReader::*read)(const Sexpr& section);
  };
  struct PartRow {
    std::string_view word;
    void (BddlReader::*read)(const Sexpr& part, BddlRegion& region);
  };

  // What a problem has, each once.
  static std::span<const SectionRow> sections() {
    static constexpr SectionRow kSections[] = {
        {"problem", &BddlReader::read_problem},
        {":domain", &BddlReader::read_domain},
        {":language", &BddlReader::read_language},
        {":regions", &BddlReader::read_regions},
        {":fixtures", &BddlReader::read_fixtures},
        {":objects", &BddlReader::read_objects},
        {":obj_of_interest", &BddlReader::read_interest},
        {":init", &BddlReader::read_init},
        {":goal", &BddlReader::read_goal},
    };
    return kSections;
  }
  static std::span<const PartRow> region_parts() {
    static constexpr PartRow kParts[] = {
        {":target", &BddlReader::read_target},
        {":ranges", &BddlReader::read_ranges},
        {":yaw_rotation", &BddlReader::read_yaw},
    };
    return kParts;
  }

  void wrong(Spot spot, std::string what) { mistakes_.push_back({spot, std::move(what)}); }
  void odd(Spot spot, std::string what) {
    read_.oddities.push_back({Fault::kUsage, std::move(what), place_of(problem_.path, spot)});
  }

  std::string shown(const Sexpr& node) const {
    if (!node.is_list) return "`" + printable(node.word, kLongestShown) + "`";
    const std::string_view head = tree_.head(node);
    return head.empty() ? "a list" : "`(" + printable(head, kLongestShown) + " ...`";
  }

  // ", did you mean `x`?", or nothing.
  static std::string meant(std::string_view word, std::span<const std::string_view> words) {
    const std::string_view* near = nearest_spelling(word, words);
    return near == nullptr ? "" : ", did you mean `" + std::string(*near) + "`?";
  }

  void read_define(const Sexpr& define) {
    if (in_lower_case(tree_.head(define)) != "define") {
      wrong(define.spot, "expected `(define`, found " + shown(define));
      return;
    }
    for (std::size_t i = 1; i < define.items.size(); ++i) read_section(tree_.at(define.items[i]));
    for (const SectionRow& section : sections()) {
      if (!seen_.contains(section.word))
        wrong(define.spot, "there is no `" + std::string(section.word) + "`");
    }
    if (mistakes_.empty()) check_names();
  }

  void read_section(const Sexpr& section) {
    const std::string word = in_lower_case(tree_.head(section));
    if (!section.is_list || word.empty()) {
      wrong(section.spot, "expected a section such as `(:objects`, found " + shown(section));
      return;
    }
    const auto known = std::ranges::find(sections(), word, &SectionRow::word);
    if (known == sections().end()) {
      wrong(section.spot, "unknown section `" + printable(word, kLongestShown) + "`" +
                              meant(word, words_of(sections())));
      return;
    }
    if (!seen_.insert(known->word).second) {
      wrong(section.spot, "section `" + word + "` is there twice");
      return;
    }
    (this->*known->read)(section);
  }

  // Names go into texts as they are: letters, digits and `_`, a letter first.
  void check_spelling(const Sexpr& word) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const bool is_spelt = !word.word.empty() && is_letter(word.word.front()) &&
                          std::ranges::all_of(word.word, [&](char c) {
                            return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
                          });
    if (!is_spelt)
      wrong(word.spot, shown(word) + " is no name: letters, digits and `_`, a letter first");
  }

  // The only word behind the head; reported where there is another number of them.
  std::optional<std::string> only_word(const Sexpr& list) {
    if (list.items.size() == 2 && !tree_.at(list.items[1]).is_list)
      return in_lower_case(tree_.at(list.items[1]).word);
    wrong(list.spot, "expected one word in " + shown(list));
    return std::nullopt;
  }

  void read_problem(const Sexpr& section) {
    if (auto word = only_word(section)) problem_.problem_class = std::move(*word);
  }
  void read_domain(const Sexpr& section) {
    const auto word = only_word(section);
    if (word && *word != "robosuite")
      odd(section.spot, "the domain is `" + *word + "`, not `robosuite`");
  }
  void read_language(const Sexpr& section) {
    for (std::size_t i = 1; i < section.items.size(); ++i) {
      const Sexpr& word = tree_.at(section.items[i]);
      if (word.is_list) {
        wrong(word.spot, "expected words behind `:language`, found " + shown(word));
        return;
      }
      problem_.language += (i == 1 ? "" : " ") + std::string(word.word);
    }
    if (problem_.language.empty()) wrong(section.spot, "there are no words behind `:language`");
  }

  void read_fixtures(const Sexpr& section) { read_things(section, problem_.fixtures); }
  void read_objects(const Sexpr& section) { read_things(section, problem_.objects); }

  // "a b - category", again and again.
  void read_things(const Sexpr& section, std::vector<BddlThing>& things) {
    std::size_t named = things.size();
    for (std::size_t i = 1; i < section.items.size(); ++i) {
      const Sexpr& word = tree_.at(section.items[i]);
      if (word.is_list) {
        wrong(word.spot, "expected a name, found " + shown(word));
        return;
      }
      if (word.word != "-") {
        check_spelling(word);
        things.push_back({in_lower_case(word.word), {}, word.spot});
        continue;
      }
      if (i + 1 == section.items.size() || tree_.at(section.items[i + 1]).is_list ||
          named == things.size()) {
        wrong(word.spot, "expected `name - category`");
        return;
      }
      check_spelling(tree_.at(section.items[++i]));
      const std::string category = in_lower_case(tree_.at(section.items[i]).word);
      for (; named < things.size(); ++named) things[named].category = category;
    }
    for (; named < things.size(); ++named)
      wrong(things[named].spot, "`" + things[named].name + "` has no category");
  }

  void read_interest(const Sexpr& section) {
    for (std::size_t i = 1; i < section.items.size(); ++i) {
      const Sexpr& word = tree_.at(section.items[i]);
      if (word.is_list) {
        wrong(word.spot, "expected a name, found " + shown(word));
        return;
      }
      problem_.interest.push_back(in_lower_case(word.word));
    }
  }

  // ---- regions

  void read_regions(const Sexpr& section) {
    for (std::size_t i = 1; i < section.items.size(); ++i) {
      const Sexpr& node = tree_.at(section.items[i]);
      const std::string_view own = tree_.head(node);
      if (!node.is_list || own.empty()) {
        wrong(node.spot, "expected `(name (:target ..) ..`, found " + shown(node));
        continue;
      }
      check_spelling(tree_.at(node.items[0]));
      BddlRegion region;
      region.spot = node.spot;
      region.own = in_lower_case(own);
      for (std::size_t k = 1; k < node.items.size(); ++k)
        read_region_part(tree_.at(node.items[k]), region);
      if (region.target.empty()) {
        wrong(node.spot, "region `" + region.own + "` has no `:target`");
        continue;
      }
      region.name = region.target + "_" + region.own;
      problem_.regions.push_back(std::move(region));
    }
  }

  void read_region_part(const Sexpr& part, BddlRegion& region) {
    const std::string word = in_lower_case(tree_.head(part));
    const auto known = std::ranges::find(region_parts(), word, &PartRow::word);
    if (known == region_parts().end()) {
      wrong(part.spot,
            "unknown part of a region, " + shown(part) + meant(word, words_of(region_parts())));
      return;
    }
    (this->*known->read)(part, region);
  }

  void read_target(const Sexpr& part, BddlRegion& region) {
    if (auto target = only_word(part)) region.target = std::move(*target);
  }
  void read_ranges(const Sexpr& part, BddlRegion& region) {
    for (const auto& [numbers, spot] : tuples_in(part, 4)) {
      if (numbers[0] > numbers[2] || numbers[1] > numbers[3]) {
        wrong(spot, "the second corner of a rectangle lies below the first");
      } else {
        region.ranges.push_back({numbers[0], numbers[1], numbers[2], numbers[3]});
      }
    }
  }
  void read_yaw(const Sexpr& part, BddlRegion& region) {
    const auto tuples = tuples_in(part, 2);
    if (tuples.size() == 1) region.yaw = {tuples[0].first[0], tuples[0].first[1]};
    if (tuples.size() > 1) wrong(part.spot, "a region has one `:yaw_rotation`");
  }

  // ((1 2) (3 4)) behind a head: lists of `count` numbers. What is something else is reported.
  std::vector<std::pair<std::vector<double>, Spot>> tuples_in(const Sexpr& part,
                                                              std::size_t count) {
    std::vector<std::pair<std::vector<double>, Spot>> tuples;
    if (part.items.size() != 2 || !tree_.at(part.items[1]).is_list) {
      wrong(part.spot, "expected one list of lists of numbers in " + shown(part));
      return tuples;
    }
    for (const std::uint32_t item : tree_.at(part.items[1]).items) {
      const Sexpr& list = tree_.at(item);
      if (!list.is_list || list.items.size() != count) {
        wrong(list.spot, fmt::format("expected {} numbers in brackets", count));
        continue;
      }
      std::vector<double> numbers;
      for (const std::uint32_t number : list.items) {
        if (const auto value = number_of(tree_.at(number))) numbers.push_back(*value);
      }
      if (numbers.size() == count) tuples.emplace_back(std::move(numbers), list.spot);
    }
    return tuples;
  }

  std::optional<double> number_of(const Sexpr& node) {
    double value = 0;
    const char* const end = node.word.data() + node.word.size();
    const auto [at, error] = std::from_chars(node.word.data(), end, value);
    const bool is_number = !node.is_list && error == std::errc() && at == end;
    // Metres and radians.
    constexpr double kFarthest = 1000;
    if (is_number && std::abs(value) <= kFarthest) return value;
    wrong(node.spot, "expected a number" + std::string(is_number ? " from -1000 to 1000" : "") +
                         ", found " + shown(node));
    return std::nullopt;
  }

  // ---- facts

  std::optional<BddlFact> fact_of(const Sexpr& node) {
    BddlFact fact;
    fact.spot = node.spot;
    fact.predicate = in_lower_case(tree_.head(node));
    if (!node.is_list || fact.predicate.empty()) {
      wrong(node.spot, "expected a fact such as `(On a b)`, found " + shown(node));
      return std::nullopt;
    }
    const auto known = std::ranges::find(kPredicates, fact.predicate, &PredicateRow::word);
    if (known == std::end(kPredicates)) {
      wrong(node.spot, "unknown predicate `" + printable(fact.predicate, kLongestShown) + "`" +
                           meant(fact.predicate, words_of(kPredicates)));
      return std::nullopt;
    }
    for (std::size_t i = 1; i < node.items.size(); ++i) {
      const Sexpr& word = tree_.at(node.items[i]);
      if (word.is_list) {
        wrong(word.spot, "expected a name, found " + shown(word));
        return std::nullopt;
      }
      fact.arguments.push_back(in_lower_case(word.word));
    }
    if (fact.arguments.size() == 2 && fact.arguments[0] == fact.arguments[1]) {
      wrong(node.spot, "`" + fact.predicate + "` says of `" +
                           printable(fact.arguments[0], kLongestShown) + "` how it is to itself");
      return std::nullopt;
    }
    if (fact.arguments.size() == known->arguments) return fact;
    wrong(node.spot, fmt::format("`{}` takes {} name{}, found {}", fact.predicate, known->arguments,
                                 known->arguments == 1 ? "" : "s", fact.arguments.size()));
    return std::nullopt;
  }

  void read_init(const Sexpr& section) {
    for (std::size_t i = 1; i < section.items.size(); ++i) {
      if (auto fact = fact_of(tree_.at(section.items[i])))
        problem_.init.push_back(std::move(*fact));
    }
  }
  void read_goal(const Sexpr& section) {
    if (section.items.size() != 2 ||
        in_lower_case(tree_.head(tree_.at(section.items[1]))) != "and") {
      wrong(section.spot, "expected one `(And ..)` behind `:goal`");
      return;
    }
    const Sexpr& all = tree_.at(section.items[1]);
    for (std::size_t i = 1; i < all.items.size(); ++i) {
      auto fact = fact_of(tree_.at(all.items[i]));
      if (!fact) continue;
      const bool is_said = std::ranges::any_of(problem_.goal, [&](const BddlFact& one) {
        return one.predicate == fact->predicate && one.arguments == fact->arguments;
      });
      if (is_said) odd(fact->spot, "the goal wants the same twice");
      if (!is_said) problem_.goal.push_back(std::move(*fact));
    }
    if (all.items.size() == 1) wrong(all.spot, "the goal wants nothing");
  }

  // ---- what is said of what

  void check_names() {
    std::set<std::string, std::less<>> things, regions;
    const BddlRegion* on_table = nullptr;
    for (const BddlRegion& region : problem_.regions) {
      if (region.ranges.empty()) continue;
      if (on_table == nullptr) on_table = &region;
      if (region.target != on_table->target)
        wrong(region.spot, "`:ranges` are of `" + region.target + "` and of `" + on_table->target +
                               "`: a problem has one table or floor");
    }
    for (const auto* list : {&problem_.fixtures, &problem_.objects}) {
      for (const BddlThing& thing : *list) {
        if (!things.insert(thing.name).second)
          wrong(thing.spot, "`" + thing.name + "` is declared twice");
      }
    }
    for (const BddlRegion& region : problem_.regions) {
      if (!regions.insert(region.name).second)
        wrong(region.spot, "`" + region.target + "` has two regions `" + region.own + "`");
      if (!things.contains(region.target))
        odd(region.spot, "region `" + region.own + "` is of `" + region.target +
                             "`, which the problem does not have");
      else if (region.ranges.empty() && is_workspace(region.target))
        odd(region.spot, "region `" + region.own + "` of `" + region.target + "` has no `:ranges`");
    }
    const auto check = [&](const std::string& name, Spot spot) {
      if (things.contains(name) || regions.contains(name)) return;
      std::vector<std::string_view> known(things.begin(), things.end());
      known.insert(known.end(), regions.begin(), regions.end());
      wrong(spot, "there is no `" + printable(name, kLongestShown) + "`" + meant(name, known));
    };
    for (const auto* facts : {&problem_.init, &problem_.goal}) {
      for (const BddlFact& fact : *facts) {
        for (const std::string& name : fact.arguments) check(name, fact.spot);
      }
    }
    for (const std::string& name : problem_.interest) {
      if (!things.contains(name) && !regions.contains(name))
        odd({1, 1}, "of interest is `" + name + "`, which the problem does not have");
    }
  }

  // The table or floor: no other fixture has rectangles.
  bool is_workspace(const std::string& name) const {
    return std::ranges::any_of(problem_.regions, [&](const BddlRegion& region) {
      return region.target == name && !region.ranges.empty();
    });
  }

  BddlRead& read_;
  BddlProblem& problem_;
  Sexprs tree_;
  std::vector<Mistake> mistakes_;  // as they are found
  std::set<std::string_view> seen_;
};

template <typename T>
const T* find_named(const std::vector<T>& all, std::string_view name) {
  const auto at = std::ranges::find(all, name, &T::name);
  return at == all.end() ? nullptr : &*at;
}

}  // namespace

const BddlThing* BddlProblem::find_object(std::string_view name) const {
  return find_named(objects, name);
}
const BddlThing* BddlProblem::find_fixture(std::string_view name) const {
  return find_named(fixtures, name);
}
const BddlRegion* BddlProblem::find_region(std::string_view name) const {
  return find_named(regions, name);
}

BddlRead read_bddl(std::string_view text, const std::string& path) {
  BddlRead read;
  read.problem.path = path;
  BddlReader(read).read(text);
  return read;
}

}  // namespace probe::libero
