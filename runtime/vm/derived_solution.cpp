#include "runtime/vm/derived_solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/regions.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/skills.h"
#include "runtime/vm/made_up.h"
#include "runtime/vm/placed_world.h"

namespace probe::vm {
namespace {

constexpr double kAngleStep = std::numbers::pi / 36;  // rad: how finely a wanted turn is found
constexpr double kTurnRoom = 2;                       // steps more than the least that is enough
constexpr std::size_t kMostPuts = 150;                // of which all pairs are asked about
constexpr std::size_t kMostReordered = 5;             // skills of which every order is asked about
constexpr double kHalfOpen = 0.5;  // of the way: what is less open is opened to put something in

// A part's joint at one of its ends, or turned by an angle.
struct JointMove {
  std::uint32_t body = plan::kNone;
  std::size_t joint = 0;  // of all joints of the scene's fixtures
  plan::Skill skill = plan::Skill::kOpen;
  double position = 0;
  double amount = 0;  // rad from where it is closed, of a turn
};

// Where things are when skills are done: each object in its place, joints where they were moved to.
struct Arranged {
  std::vector<std::pair<std::uint32_t, PutPlace>> objects;
  std::vector<JointMove> joints;
};

struct Bundle {
  std::vector<std::uint32_t> objects;
  PutPlace place;
  std::vector<JointMove> joints;
  std::size_t size() const { return objects.size() + joints.size(); }
  Arranged arranged() const {
    Arranged out{{}, joints};
    for (const std::uint32_t object : objects) out.objects.emplace_back(object, place);
    return out;
  }
};

class Deriver {
 public:
  Deriver(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
          std::uint32_t start = 0)
      : plan_(plan),
        task_(task),
        success_(success),
        record_(plan.tasks()[task]),
        roles_(plan::roles_of(plan.tables(), record_)),
        start_(start),
        still_(make_up_world(plan, task, start)),
        joints_(plan::joints_of(plan.tables(), plan.scenes()[record_.scene])) {}

  Result<std::vector<plan::SkillRecord>> run() {
    std::vector<plan::SkillRecord> none;
    PROBE_ASSIGN(const bool at_once, holds({}));
    if (at_once || plan_.episodes(record_).empty()) return none;
    find_joint_moves();
    for (const Bundle& bundle : bundles()) {
      PROBE_ASSIGN(const bool is_enough, holds(bundle));
      if (!is_enough) continue;
      PROBE_ASSIGN(const Bundle least, without_needless(bundle));
      return skills_of(least);
    }
    return in_turn();
  }

  // Whether success is true as well when what is put first and what is put next are put the other
  // way round. False of skills that put fewer than two things, or of which it cannot be told.
  Result<bool> holds_either_way(std::span<const plan::SkillRecord> skills) {
    if (plan_.episodes(record_).empty()) return false;
    std::vector<std::pair<std::uint32_t, PutPlace>> puts;
    find_joint_moves();
    std::vector<JointMove> joints;
    for (const plan::SkillRecord& skill : skills) {
      const auto kind = static_cast<plan::Skill>(skill.skill);
      if (kind == plan::Skill::kPut) {
        puts.emplace_back(skill.body, place_of(skill));
        continue;
      }
      const Arranged done{puts, joints};
      const auto move = is_joint_skill(kind) ? move_of(skill, done) : std::nullopt;
      if (!move) return false;
      std::erase_if(joints, [&](const JointMove& other) { return other.joint == move->joint; });
      joints.push_back(*move);
    }
    if (puts.size() != 2 || puts[0].first == puts[1].first) return false;
    for (int way = 0; way < 2; ++way) {
      const std::vector<Arranged> stages = {{{puts[0]}, {}}, {puts, {}}, {puts, joints}};
      PROBE_ASSIGN(const bool is_success, holds_through(stages));
      if (!is_success) return false;
      std::swap(puts[0], puts[1]);
    }
    return true;
  }

  // What is amiss with skills that were said; empty where nothing is, or where that cannot be found
  // out.
  Result<std::string> flaw(std::span<const plan::SkillRecord> said) {
    if (plan_.episodes(record_).empty()) return std::string();
    find_joint_moves();
    Arranged done;
    std::vector<Arranged> stages;
    for (const plan::SkillRecord& skill : said) {
      if (goes_into_closed(skill, done))
        return fmt::format("`{}` goes into what is closed then",
                           plan::skill_text(plan_.tables(), skill));
      if (!add(skill, &done)) return std::string();
      stages.push_back(done);
    }
    // What is held at the end is where the hand is.
    if (static_cast<plan::Skill>(said.back().skill) == plan::Skill::kPick) return std::string();
    for (const bool handled : {false, true}) {
      PROBE_ASSIGN(const bool is_success, holds_with(done, handled));
      if (is_success) return std::string();
    }
    PROBE_ASSIGN(const bool is_success_in_turn, holds_through(stages));
    if (is_success_in_turn) return std::string();
    moves_.clear();
    places_.clear();
    PROBE_ASSIGN(const auto derived, run());
    if (derived.empty()) return std::string();
    std::string other;
    for (const plan::SkillRecord& skill : derived)
      other += (other.empty() ? "" : "; ") + plan::skill_text(plan_.tables(), skill);
    return fmt::format("when it is done `success` is not true; `{}` makes it so", other);
  }

  // Where `ends`, what ends an episode, holds before all of the skills are done and success is not
  // true then: in the order in which they are said, or else in each in which they can be done.
  Result<std::optional<EarlyEnd>> early_end(std::span<const plan::SkillRecord> skills, bool is_said,
                                            std::uint32_t ends) {
    if (skills.size() > kMostReordered && !is_said) return std::optional<EarlyEnd>();
    moves_.clear();
    places_.clear();
    find_joint_moves();
    Walk walk{{skills.begin(), skills.end()}, is_said, ends, {}, {}, {}};
    PROBE_ASSIGN(const bool comes_through, can_be_done(walk));
    if (comes_through || !walk.found) return std::optional<EarlyEnd>();
    return walk.found;
  }

 private:
  // Skills in one order: those that are done, how things lie after each, and those that are left.
  struct Walk {
    std::vector<plan::SkillRecord> left;
    bool is_in_order = false;
    std::uint32_t ends = 0;  // metric
    std::vector<plan::SkillRecord> done;
    std::vector<Arranged> stages;
    std::optional<EarlyEnd> found;  // by the first order that was tried
  };

  // Whether some order of what is left does all of it before the episode ends, or ends it with
  // success; also where it cannot be told.
  Result<bool> can_be_done(Walk& walk) const {
    if (walk.left.empty()) return true;
    if (!walk.stages.empty() && !is_held_after(walk)) {
      PROBE_ASSIGN(const bool is_over, holds_in_all(walk.ends, walk.stages));
      if (is_over) {
        PROBE_ASSIGN(const bool is_success, holds_in_any(success_, walk.stages));
        if (!is_success && !walk.found) walk.found = EarlyEnd{0, walk.done, walk.left};
        return is_success;
      }
    }
    for (std::size_t i = 0; i < walk.left.size() && (i == 0 || !walk.is_in_order); ++i) {
      const plan::SkillRecord skill = walk.left[i];
      Arranged after = walk.stages.empty() ? Arranged{} : walk.stages.back();
      if (!walk.is_in_order && (goes_into_closed(skill, after) || waits(walk, i))) continue;
      if (!add(skill, &after)) return true;
      walk.left.erase(walk.left.begin() + static_cast<std::ptrdiff_t>(i));
      walk.done.push_back(skill);
      walk.stages.push_back(std::move(after));
      PROBE_ASSIGN(const bool is_done, can_be_done(walk));
      walk.stages.pop_back();
      walk.done.pop_back();
      walk.left.insert(walk.left.begin() + static_cast<std::ptrdiff_t>(i), skill);
      if (is_done) return true;
    }
    return false;
  }

  // What one has in the hand is where that is.
  static bool is_held_after(const Walk& walk) {
    return static_cast<plan::Skill>(walk.done.back().skill) == plan::Skill::kPick;
  }

  // What is done twice to one thing is done in the order in which it is said: opened, then closed.
  static bool waits(const Walk& walk, std::size_t at) {
    return std::any_of(
        walk.left.begin(), walk.left.begin() + static_cast<std::ptrdiff_t>(at),
        [&](const plan::SkillRecord& other) { return other.body == walk.left[at].body; });
  }

  // What is so when a skill is done as well; false where that is not known.
  bool add(const plan::SkillRecord& skill, Arranged* done) const {
    const auto lies = [&](const auto& put) { return put.first == skill.body; };
    switch (static_cast<plan::Skill>(skill.skill)) {
      case plan::Skill::kPick:
        std::erase_if(done->objects, lies);
        return true;
      case plan::Skill::kPut:
        std::erase_if(done->objects, lies);
        done->objects.emplace_back(skill.body, place_of(skill));
        return true;
      case plan::Skill::kOpen:
      case plan::Skill::kClose:
      case plan::Skill::kTurn: {
        const auto move = move_of(skill, *done);
        if (!move) return false;
        std::erase_if(done->joints,
                      [&](const JointMove& other) { return other.joint == move->joint; });
        done->joints.push_back(*move);
        return true;
      }
      case plan::Skill::kPress:
      case plan::Skill::kPush:
        return false;
    }
    return false;
  }

  static PutPlace place_of(const plan::SkillRecord& put) {
    return {put.to, put.region, static_cast<plan::SkillRelation>(put.relation)};
  }
  static bool is_joint_skill(plan::Skill skill) {
    return skill == plan::Skill::kOpen || skill == plan::Skill::kClose ||
           skill == plan::Skill::kTurn;
  }

  // Those that are put somewhere: all that have a role but the target, and no distractors.
  std::vector<std::uint32_t> moved_objects() const {
    std::vector<std::uint32_t> moved;
    for (std::uint32_t o = 0; o < roles_.objects; ++o) {
      const bool has_role = !plan::role_of_body(plan_.tables(), roles_, o).empty();
      if (has_role && o != roles_.target && !roles_.is_distractor(o)) moved.push_back(o);
    }
    return moved;
  }

  // Two things, each to a place of its own, or one after the other, where no bundle makes success.
  Result<std::vector<plan::SkillRecord>> in_turn() const {
    std::vector<plan::SkillRecord> none;
    const std::vector<std::uint32_t> moved = moved_objects();
    using Put = std::pair<std::uint32_t, PutPlace>;
    std::vector<Put> puts;
    for (const std::uint32_t object : moved) {
      for (const PutPlace& place : places_) {
        if (place.relation == plan::SkillRelation::kBeside) continue;
        plan::SkillRecord put = put_of(object, place);
        if (body_of(place) != object && !goes_into_closed(put, {}))
          puts.emplace_back(object, place);
      }
    }
    if (moved.size() < 2 || puts.size() > kMostPuts) return none;
    for (const Put& first : puts) {
      for (const Put& second : puts) {
        if (first.first == second.first || body_of(first.second) == second.first) continue;
        const std::vector<Arranged> stages = {{{first}, {}}, {{first, second}, {}}};
        PROBE_ASSIGN(const bool is_enough, holds_through(stages));
        if (is_enough)
          return std::vector{put_of(first.first, first.second),
                             put_of(second.first, second.second)};
      }
    }
    return none;
  }

  // What is moved when a place is moved.
  std::uint32_t body_of(const PutPlace& place) const {
    return place.region == plan::kNone ? place.to : *owner_of(plan_.regions()[place.region]);
  }
  plan::SkillRecord put_of(std::uint32_t object, const PutPlace& place) const {
    plan::SkillRecord put = record_of(plan::Skill::kPut, object);
    put.relation = static_cast<std::uint32_t>(place.relation);
    put.to = place.to;
    put.region = place.region;
    return put;
  }

  double position_of(std::size_t joint, const Arranged& done) const {
    const auto moved = std::ranges::find(done.joints, joint, &JointMove::joint);
    if (moved != done.joints.end()) return moved->position;
    return still_.sample.joints[still_.sample.joints.size() - joints_.size() + joint].position;
  }

  // Into a region of a part that is less than half open.
  bool goes_into_closed(const plan::SkillRecord& put, const Arranged& done) const {
    if (put.region == plan::kNone ||
        static_cast<plan::SkillRelation>(put.relation) != plan::SkillRelation::kIn)
      return false;
    const auto owner = owner_of(plan_.regions()[put.region]);
    return owner && std::ranges::any_of(moves_, [&](const JointMove& move) {
             if (move.body != *owner || move.skill != plan::Skill::kOpen) return false;
             const plan::FixtureJointRecord& joint = *joints_[move.joint];
             const double left = std::abs(move.position - position_of(move.joint, done));
             return left / (joint.upper - joint.lower) > kHalfOpen;
           });
  }

  // Nothing of what has no ends.
  std::optional<JointMove> move_of(const plan::SkillRecord& skill, const Arranged& done) const {
    const auto kind = static_cast<plan::Skill>(skill.skill);
    const auto of = [&](plan::Skill wanted) {
      return std::ranges::find_if(moves_, [&](const JointMove& move) {
        return move.body == skill.body && move.skill == wanted;
      });
    };
    const auto close = of(plan::Skill::kClose), open = of(plan::Skill::kOpen);
    if (close == moves_.end() || open == moves_.end()) return std::nullopt;
    if (kind == plan::Skill::kOpen) return *open;
    if (kind == plan::Skill::kClose) return *close;
    JointMove turn = *open;
    turn.skill = kind;
    const double sign = open->position > close->position ? 1 : -1;
    const bool is_by = static_cast<plan::SkillRelation>(skill.relation) == plan::SkillRelation::kBy;
    turn.position = (is_by ? position_of(turn.joint, done) : close->position) + sign * skill.amount;
    return turn;
  }

  // Smaller ones first, so that the first that is enough says little too much.
  std::vector<Bundle> bundles() const {
    std::vector<std::vector<JointMove>> joints = {{}};
    for (const JointMove& move : moves_) joints.push_back({move});
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      for (std::size_t k = i + 1; k < moves_.size(); ++k) {
        if (moves_[i].joint != moves_[k].joint) joints.push_back({moves_[i], moves_[k]});
      }
    }
    for (const plan::Skill skill : {plan::Skill::kOpen, plan::Skill::kClose}) {
      joints.emplace_back();
      for (const JointMove& move : moves_) {
        if (move.skill == skill) joints.back().push_back(move);
      }
    }
    std::vector<std::vector<std::uint32_t>> objects = {{}};
    for (std::uint32_t o = 0; o < roles_.objects; ++o) objects.push_back({o});
    const std::vector<std::uint32_t> moved = moved_objects();
    if (moved.size() > 1) objects.push_back(moved);
    std::vector<Bundle> all;
    for (const auto& put : objects) {
      for (const PutPlace& place : put.empty() ? std::vector<PutPlace>{{}} : places_) {
        // Nothing goes onto itself, nor into what it has about it.
        if (std::ranges::find(put, body_of(place)) != put.end()) continue;
        for (const auto& moves : joints) {
          // Every pair of joints beside every put would be too many to ask about.
          const bool is_source = put.size() == 1 && roles_.has_source() && put[0] == roles_.source;
          if (!put.empty() && moves.size() > 1 && !is_source) continue;
          Bundle bundle{put, place, moves};
          if (bundle.size() > 0) all.push_back(std::move(bundle));
        }
      }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Bundle& a, const Bundle& b) { return a.size() < b.size(); });
    return all;
  }

  void find_joint_moves() {
    const auto bodies = plan_.bodies(record_);
    const plan::SceneRecord& scene = plan_.scenes()[record_.scene];
    std::size_t first = 0;
    for (const std::uint32_t index : plan::slice_of(plan_.tables().list, scene.fixtures)) {
      const plan::FixtureRecord& fixture = plan_.fixtures()[index];
      const auto records = plan::slice_of(plan_.tables().fixture_joints, fixture.joints);
      std::vector<bool> seen(records.size(), false);
      for (std::uint32_t p = 0; p < fixture.parts.count; ++p) {
        const std::uint32_t number = fixture.parts.first + p;
        const plan::PartRecord& part = plan_.tables().parts[number];
        if (part.joint == plan::kNone || seen[part.joint]) continue;
        seen[part.joint] = true;
        for (std::uint32_t b = 0; b < bodies.size(); ++b) {
          const bool is_part = bodies[b].kind == static_cast<std::uint32_t>(plan::BodyKind::kPart);
          if (is_part && bodies[b].index == number) add_moves(b, first + part.joint);
        }
      }
      first += records.size();
    }
    for (std::uint32_t o = 0; o < roles_.objects; ++o)
      places_.push_back({o, plan::kNone, plan::SkillRelation::kOn});
    for (std::uint32_t r = 0; r < plan_.regions().size(); ++r) {
      if (owner_of(plan_.regions()[r]))
        places_.push_back({plan::kNone, r, plan::SkillRelation::kIn});
    }
    for (std::uint32_t o = 0; o < roles_.objects; ++o)
      places_.push_back({o, plan::kNone, plan::SkillRelation::kIn});
    // Only where nothing else makes success.
    for (std::uint32_t o = 0; o < roles_.objects; ++o)
      places_.push_back({o, plan::kNone, plan::SkillRelation::kBeside});
  }

  void add_moves(std::uint32_t body, std::size_t joint) {
    const plan::FixtureJointRecord& record = *joints_[joint];
    if (plan::is_endless(record)) return;
    const bool at_upper = plan::closes_at_upper(record.lower, record.upper);
    const double closed = at_upper ? record.upper : record.lower;
    const double far = at_upper ? record.lower : record.upper;
    moves_.push_back({body, joint, plan::Skill::kOpen, far, 0});
    moves_.push_back({body, joint, plan::Skill::kClose, closed, 0});
    if (plan::slides(record)) return;
    // The least turn that is enough, and some more; where that is less than all.
    const double sign = far > closed ? 1 : -1;
    for (double angle = kAngleStep; angle < std::abs(far - closed); angle += kAngleStep) {
      const JointMove turn{body, joint, plan::Skill::kTurn, closed + sign * angle, angle};
      const auto enough = holds({{}, {}, {turn}});
      if (!enough.ok() || !*enough) continue;
      const double more =
          std::min(angle + kTurnRoom * kAngleStep, std::abs(far - closed) - kAngleStep);
      const double wanted = std::max(angle, more);
      moves_.insert(moves_.begin(),
                    {body, joint, plan::Skill::kTurn, closed + sign * wanted, wanted});
      return;
    }
  }

  std::optional<std::uint32_t> owner_of(const plan::RegionRecord& region) const {
    return plan::owner_of(plan_.tables(), record_, region);
  }

  // Whether success holds when all of a bundle is done and nothing is held; or, if not, while the
  // fingers are at the parts that were moved.
  Result<bool> holds(const Bundle& bundle) const {
    PROBE_ASSIGN(const bool alone, holds_with(bundle.arranged(), false));
    if (alone || bundle.joints.empty() || !bundle.objects.empty()) return alone;
    return holds_with(bundle.arranged(), true);
  }

  Result<bool> holds_with(const Arranged& bundle, bool handled) const {
    for (const Spread spread : kSpreads) {
      PROBE_ASSIGN(const bool is_success,
                   judge_world(plan_, task_, success_, world_of(still(spread), bundle, handled)));
      if (!is_success) return false;
    }
    return true;
  }

  // Whether success holds when one is so after the other, nothing having been done before the
  // first.
  Result<bool> holds_through(std::span<const Arranged> stages) const {
    return holds_in_all(success_, stages);
  }

  // The same of any metric: wherever things were made up to be, and anywhere.
  Result<bool> holds_in_all(std::uint32_t metric, std::span<const Arranged> stages) const {
    for (const Spread spread : kSpreads) {
      PROBE_ASSIGN(const bool holds, holds_from(still(spread), metric, stages));
      if (!holds) return false;
    }
    return true;
  }
  Result<bool> holds_in_any(std::uint32_t metric, std::span<const Arranged> stages) const {
    for (const Spread spread : kSpreads) {
      PROBE_ASSIGN(const bool holds, holds_from(still(spread), metric, stages));
      if (holds) return true;
    }
    return false;
  }
  Result<bool> holds_from(const MadeUpWorld& still, std::uint32_t metric,
                          std::span<const Arranged> stages) const {
    std::vector<MadeUpWorld> worlds = {still};
    for (const Arranged& stage : stages) worlds.push_back(world_of(still, stage, false));
    return judge_worlds(plan_, task_, metric, std::move(worlds));
  }

  // The others are asked about what holds in the first alone.
  const MadeUpWorld& still(Spread spread) const {
    if (spread == Spread::kAlong) return still_;
    auto& other = others_[spread == Spread::kBack ? 0 : 1];
    if (!other) other = make_up_world(plan_, task_, start_, spread);
    return *other;
  }

  MadeUpWorld world_of(const MadeUpWorld& still, const Arranged& bundle, bool handled) const {
    MadeUpWorld world = still;
    std::size_t index = 0;
    for (const auto& [object, place] : bundle.objects)
      put_at(plan_, record_, object, place, index++, &world);
    const std::size_t first =
        world.sample.joints.size() - joints_.size();  // the robot's stand before
    for (const JointMove& move : bundle.joints) {
      world.sample.joints[first + move.joint].position = move.position;
      if (!handled) continue;
      for (const std::uint16_t finger : world.fingers)
        world.sample.contacts.push_back(
            {finger, static_cast<std::uint16_t>(move.body), {0, kMadeUpContact, 0}});
    }
    put_contacts_in_order(&world);
    return world;
  }

  Result<Bundle> without_needless(Bundle bundle) const {
    for (std::size_t i = bundle.joints.size(); i-- > 0;) {
      Bundle less = bundle;
      less.joints.erase(less.joints.begin() + static_cast<std::ptrdiff_t>(i));
      if (less.size() == 0) break;
      PROBE_ASSIGN(const bool is_enough, holds(less));
      if (is_enough) bundle = std::move(less);
    }
    for (std::size_t i = bundle.objects.size(); i-- > 0;) {
      Bundle less = bundle;
      less.objects.erase(less.objects.begin() + static_cast<std::ptrdiff_t>(i));
      if (less.size() == 0) break;
      PROBE_ASSIGN(const bool is_enough, holds(less));
      if (is_enough) bundle = std::move(less);
    }
    return bundle;
  }

  JointMove closing(const JointMove& opening) const {
    return *std::ranges::find_if(moves_, [&](const JointMove& move) {
      return move.joint == opening.joint && move.skill == plan::Skill::kClose;
    });
  }

  plan::SkillRecord record_of(plan::Skill skill, std::uint32_t body) const {
    plan::SkillRecord record;
    record.task = task_;
    record.skill = static_cast<std::uint32_t>(skill);
    record.body = body;
    return record;
  }
  plan::SkillRecord record_of(const JointMove& move) const {
    plan::SkillRecord record = record_of(move.skill, move.body);
    if (move.skill != plan::Skill::kTurn) return record;
    record.relation = static_cast<std::uint32_t>(plan::SkillRelation::kTo);
    record.amount = move.amount;
    return record;
  }

  Result<std::vector<plan::SkillRecord>> skills_of(const Bundle& bundle) const {
    std::vector<plan::SkillRecord> before, puts, after;
    std::vector<JointMove> joints = bundle.joints;
    // The part whose region is filled is open while that happens.
    if (!bundle.objects.empty() && bundle.place.region != plan::kNone) {
      const std::uint32_t owner = *owner_of(plan_.regions()[bundle.place.region]);
      for (const JointMove& move : moves_) {
        if (move.body != owner || move.skill != plan::Skill::kOpen) continue;
        const plan::FixtureJointRecord& joint = *joints_[move.joint];
        const std::size_t first = still_.sample.joints.size() - joints_.size();
        const double now = still_.sample.joints[first + move.joint].position;
        const double left = std::abs(move.position - now) / (joint.upper - joint.lower);
        if (left > kHalfOpen) {
          before.push_back(record_of(move));
          // It was closed; whether it may stay open is asked, too.
          Bundle open = bundle;
          std::erase_if(open.joints,
                        [&](const JointMove& other) { return other.joint == move.joint; });
          open.joints.push_back(move);
          PROBE_ASSIGN(const bool may_stay, holds(open));
          const bool is_closed_anyway = std::ranges::any_of(joints, [&](const JointMove& other) {
            return other.joint == move.joint && other.skill != plan::Skill::kOpen;
          });
          if (!may_stay && !is_closed_anyway) joints.push_back(closing(move));
        }
        std::erase_if(joints, [&](const JointMove& other) {
          return other.joint == move.joint && other.skill == plan::Skill::kOpen;
        });
      }
    }
    for (const std::uint32_t object : bundle.objects) puts.push_back(put_of(object, bundle.place));
    for (const JointMove& move : joints) {
      const bool is_first = move.skill == plan::Skill::kOpen;
      (is_first ? before : after).push_back(record_of(move));
    }
    std::vector<plan::SkillRecord> all = std::move(before);
    all.insert(all.end(), puts.begin(), puts.end());
    all.insert(all.end(), after.begin(), after.end());
    return all;
  }

  const plan::Plan& plan_;
  const std::uint32_t task_, success_;
  const plan::TaskRecord& record_;
  const plan::TaskRoles roles_;
  const std::uint32_t start_;
  const MadeUpWorld still_;
  mutable std::array<std::optional<MadeUpWorld>, 2> others_;  // kBack, kNear, when asked for
  const std::vector<const plan::FixtureJointRecord*> joints_;
  std::vector<JointMove> moves_;
  std::vector<PutPlace> places_;
};

}  // namespace

Result<std::vector<plan::SkillRecord>> derive_solution(const plan::Plan& plan, std::uint32_t task,
                                                       std::uint32_t start) {
  const auto success = plan.find_metric(plan.tasks()[task], "success");
  if (!success) return std::vector<plan::SkillRecord>();
  return Deriver(plan, task, *success, start).run();
}

Result<std::string> flaw_of_solution(const plan::Plan& plan, std::uint32_t task) {
  const auto said = plan::skills_of(plan.tables(), task);
  const auto success = plan.find_metric(plan.tasks()[task], "success");
  if (said.empty() || !success) return std::string();
  const std::vector<std::uint32_t> kinds = kinds_of_starts(plan, task);
  for (const std::uint32_t start : kinds) {
    PROBE_ASSIGN(std::string flaw, Deriver(plan, task, *success, start).flaw(said));
    if (flaw.empty()) continue;
    return start == 0 ? flaw : fmt::format("where it begins as in start {}: {}", start, flaw);
  }
  return std::string();
}

Result<std::optional<EarlyEnd>> early_end(const plan::Plan& plan, std::uint32_t task) {
  const auto success = plan.find_metric(plan.tasks()[task], "success");
  const auto ends = plan.find_metric(plan.tasks()[task], plan::kEndsMetric);
  if (!success || !ends || plan.episodes(plan.tasks()[task]).empty())
    return std::optional<EarlyEnd>();
  const auto said = plan::skills_of(plan.tables(), task);
  for (const std::uint32_t start : kinds_of_starts(plan, task)) {
    // What is over as it begins is told by P0607.
    PROBE_ASSIGN(const bool is_over,
                 judge_world(plan, task, *ends, make_up_world(plan, task, start)));
    if (is_over) continue;
    Deriver deriver(plan, task, *success, start);
    std::vector<plan::SkillRecord> skills(said.begin(), said.end());
    if (said.empty()) {
      PROBE_ASSIGN(skills, deriver.run());
    }
    PROBE_ASSIGN(auto found, deriver.early_end(skills, !said.empty(), *ends));
    if (!found) continue;
    found->start = start;
    return found;
  }
  return std::optional<EarlyEnd>();
}

Result<bool> holds_in_either_order(const plan::Plan& plan, std::uint32_t task) {
  const auto said = plan::skills_of(plan.tables(), task);
  const auto success = plan.find_metric(plan.tasks()[task], "success");
  if (!success) return false;
  for (const std::uint32_t start : kinds_of_starts(plan, task)) {
    std::vector<plan::SkillRecord> skills(said.begin(), said.end());
    if (skills.empty()) {
      PROBE_ASSIGN(skills, derive_solution(plan, task, start));
    }
    PROBE_ASSIGN(const bool is_either,
                 Deriver(plan, task, *success, start).holds_either_way(skills));
    if (is_either) return true;
  }
  return false;
}

}  // namespace probe::vm
