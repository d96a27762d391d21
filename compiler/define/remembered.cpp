#include "compiler/define/remembered.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <type_traits>
#include <variant>

#include "compiler/define/views.h"

namespace probe::sema {
namespace {

using Key = Remembered::Key;

// Numbers and texts of something, in an order that tells them apart.
class KeyMaker {
 public:
  void add(std::uint64_t word) {
    key_.a = (key_.a ^ word) * 0x9e37'79b9'7f4a'7c15u;
    key_.a ^= key_.a >> 31;
    key_.b = (key_.b + word) * 0xd134'2543'de82'ef95u;
    key_.b ^= key_.b >> 29;
  }
  template <typename Id>
  void add_id(Id id) {
    add(static_cast<std::uint64_t>(id));
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const Key& key) {
    add(key.a);
    add(key.b);
  }
  void add(std::string_view text) {
    add(std::uint64_t{text.size()});
    std::uint64_t word = 0;
    std::size_t at = 0;
    for (; at + sizeof word <= text.size(); at += sizeof word) {
      std::memcpy(&word, text.data() + at, sizeof word);
      add(word);
    }
    word = 0;
    std::memcpy(&word, text.data() + at, text.size() - at);
    add(word);
  }
  // Never none.
  Key key() const { return {key_.a | 1, key_.b}; }

 private:
  Key key_{0x243f'6a88'85a3'08d3u, 0x1319'8a2e'0370'7344u};
};

// What makes tasks, or lists them, and what one is put in place of another while it is tried: lights
// and layouts are in the key of the task that they are of.
template <typename Node>
constexpr bool is_of_tasks =
    std::is_same_v<Node, syntax::UseDecl> || std::is_same_v<Node, syntax::TaskDecl> ||
    std::is_same_v<Node, syntax::VariantDecl> || std::is_same_v<Node, syntax::VariantsDecl> ||
    std::is_same_v<Node, syntax::DeriveDecl> || std::is_same_v<Node, syntax::SetDecl> ||
    std::is_same_v<Node, syntax::SuiteDecl> || std::is_same_v<Node, syntax::QuestionsDecl> ||
    std::is_same_v<Node, syntax::SpaceDecl> || std::is_same_v<Node, syntax::LightDecl> ||
    std::is_same_v<Node, syntax::LayoutDecl>;

// The files that a layout's starts are read from.
void add_starts(KeyMaker& out, const syntax::LayoutDecl& layout, const SourceSet& sources) {
  for (const syntax::LayoutStmt& stmt : layout.body) {
    const auto* starts = std::get_if<syntax::StartsStmt>(&stmt);
    if (starts != nullptr && !starts->file.is_none()) out.add(sources.file(starts->file).text());
  }
}

}  // namespace

Key Remembered::stamp_of(const std::string& path) {
  namespace fs = std::filesystem;
  KeyMaker out;
  std::error_code error;
  out.add(std::string_view(path));
  out.add(static_cast<std::uint64_t>(fs::last_write_time(path, error).time_since_epoch().count()));
  out.add(static_cast<std::uint64_t>(fs::file_size(path, error)));
  return out.key();
}

namespace {

// `stamp`: of a file of URDF, as it was read.
template <typename Stamp>
Key made_of(const Context& context, const Stamp& stamp) {
  KeyMaker out;
  for (const std::string& folder : context.asset_root.folders()) out.add(std::string_view(folder));
  for (const syntax::File* file : context.files) {
    for (const syntax::Decl& decl : file->decls) {
      if (const auto* layout = std::get_if<syntax::LayoutDecl>(&decl.node))
        add_starts(out, *layout, context.sources);
      const bool is_task = std::visit(
          [](const auto& node) { return is_of_tasks<std::decay_t<decltype(node)>>; }, decl.node);
      if (is_task) continue;
      out.add(std::uint64_t{decl.node.index() * 2 + (decl.complete ? 1 : 0)});
      out.add(context.sources.text(decl.span));
    }
  }
  const Model& model = context.model;
  for (const Robot& robot : model.robots) {
    if (!robot.urdf.text.empty()) out.add(stamp(context.asset_root.file(robot.urdf.text)));
  }
  for (const Fixture& fixture : model.fixtures) {
    if (!fixture.urdf.text.empty()) out.add(stamp(context.asset_root.file(fixture.urdf.text)));
  }
  // What tasks fill roles with is known before they are read.
  out.add(std::uint64_t{model.has_part_distractors});
  for (const Role& role : model.roles) out.add(std::uint64_t{role.takes_things});
  return out.key();
}

// Of each layout: its text, and those that it copies.
std::vector<Key> layout_keys(const Context& context) {
  const auto& declared = context.symbols.layout_decls;
  std::vector<Key> keys(context.model.layouts.size());
  for (std::size_t i = 0; i < keys.size() && i < declared.size(); ++i) {
    KeyMaker out;
    std::size_t at = i;
    for (std::size_t hops = 0; hops <= keys.size(); ++hops) {
      const Layout& layout = context.model.layouts[context.model.layouts.id(at)];
      out.add(std::uint64_t{declared[at].decl->complete} << 1 | std::uint64_t{layout.broken});
      out.add(context.sources.text(declared[at].decl->span));
      if (layout.like == LayoutId::kNone) break;
      at = static_cast<std::size_t>(layout.like);
    }
    keys[i] = out.key();
  }
  return keys;
}

}  // namespace

void Remembered::begin(const Context& context) {
  const Model& model = context.model;
  ++analysis_;
  made_of_ = made_of(context, [this](const std::string& path) {
    const auto at = described_.find(path);
    return at == described_.end() ? stamp_of(path) : at->second.first;
  });
  objects_ = model.objects.size();
  scenes_ = model.scenes.size();
  layouts_ = layout_keys(context);
  cameras_ = model.cameras.size();
  names_objects_ = model.exprs.names_objects;
  spatial_.clear();
  for (const Object& object : model.objects) {
    for (const Phrase& phrase : object.phrases) {
      if (phrase.is_spatial()) spatial_.insert(phrase.name);
    }
  }
  words_.clear();
  lights_.clear();
  keys_.clear();
  checked_.clear();
  drop_old();
}

// Texts that come again, such as one before an edit that is taken back, are met again.
void Remembered::drop_old() {
  constexpr std::size_t kMost = 200'000, kMostLists = 5'000;
  constexpr std::size_t kMostStarts = 200'000;  // of all lists: some hundred bytes each
  const auto is_old = [&](std::uint64_t met) { return met + 1 < analysis_; };
  const auto drop = [&](auto& all, std::size_t most) {
    if (all.size() <= most) return;
    std::erase_if(all, [&](const auto& item) {
      if constexpr (requires { item.second.met; }) return is_old(item.second.met);
      else return is_old(item.second.second);
    });
  };
  drop(followed_, kMost);
  drop(compared_, kMost);
  drop(choices_, kMost);
  std::size_t starts = 0;
  for (const auto& [key, list] : starts_) starts += list.first.size();
  drop(starts_, starts > kMostStarts ? 0 : kMostLists);
}

const Key& Remembered::words_key(const Model& model, TemplateId say) {
  const auto index = static_cast<std::size_t>(say);
  if (index >= words_.size()) words_.resize(model.templates.size());
  Key& known = words_[index];
  if (!known.is_none()) return known;
  const Template& words = model.templates[say];
  KeyMaker out;
  out.add(std::string_view(words.name));
  out.add(std::string_view(words.frame));
  out.add(std::uint64_t{words.broken});
  for (const Template::Part& part : words.parts) {
    out.add(std::string_view(part.literal));
    if (!part.slot) {
      out.add(std::uint64_t{0});
      continue;
    }
    const SlotRef& slot = *part.slot;
    out.add(std::uint64_t{1} | std::uint64_t{slot.avoid} << 1 | std::uint64_t{slot.the} << 2 |
            std::uint64_t{slot.category.has_value()} << 3 |
            static_cast<std::uint64_t>(slot.count) << 8 | std::uint64_t{slot.number} << 32);
    out.add(std::string_view(slot.name.text));
    out.add_id(slot.role);
    if (slot.category) out.add(std::string_view(slot.category->text));
  }
  return known = out.key();
}

const Key& Remembered::light_key(const Model& model, LightId id) {
  static const Key kNone;
  if (id == LightId::kNone) return kNone;
  const auto index = static_cast<std::size_t>(id);
  if (index >= lights_.size()) lights_.resize(model.lights.size());
  Key& known = lights_[index];
  if (!known.is_none()) return known;
  // As Light::operator== compares them: equal ones that have two keys are looked at twice, no more.
  const Light& light = model.lights[id];
  KeyMaker out;
  out.add(light.ambient);
  out.add(std::uint64_t{light.occlusion} << 1 | std::uint64_t{light.lights_vertices});
  for (const double part : light.color) out.add(part);
  out.add(std::uint64_t{light.suns.size()});
  for (const plan::SunRecord& sun : light.suns) {
    for (const double part : sun.direction) out.add(part);
    out.add(sun.power);
    out.add(std::uint64_t{sun.shadow});
  }
  // Lamps are many numbers and few: what is lit by one is looked at in each analysis.
  if (!light.lamps.empty()) out.add(analysis_);
  return known = out.key();
}

Key Remembered::key_of(const Model& model, const Task& task) {
  // What these depend on is more than what stands in a key.
  const bool is_plain = !task.abstract && task.clear.empty() && task.later.empty() &&
                        !task.delay_time && task.overrides.empty() && task.solution.empty() &&
                        task.motions.empty() && task.say != TemplateId::kNone;
  if (!is_plain) return {};
  // Nor is what tasks add themselves known by its number.
  const auto is_declared = [](auto id, std::size_t count) {
    return id == decltype(id)::kNone || static_cast<std::size_t>(id) < count;
  };
  if (!is_declared(task.scene, scenes_) || task.scene == SceneId::kNone ||
      task.layout == LayoutId::kNone || !is_declared(task.layout, layouts_.size()))
    return {};
  KeyMaker out;
  bool is_known = true;
  const auto add_object = [&](ObjectId id) {
    is_known = is_known && is_declared(id, objects_);
    out.add_id(id);
  };
  const auto add_objects = [&](const std::vector<ObjectId>& objects) {
    out.add(std::uint64_t{objects.size()});
    for (const ObjectId id : objects) add_object(id);
  };
  out.add(made_of_);
  out.add(words_key(model, task.say));
  out.add_id(task.scene);
  out.add(layouts_[static_cast<std::size_t>(task.layout)]);
  out.add_id(task.metrics);
  out.add(light_key(model, light_of(model, task)));
  out.add(std::uint64_t{task.light != LightId::kNone});  // its own is an axis, its scene's is none
  out.add(std::uint64_t{task.cameras.size()});
  for (const Task::OtherCamera& other : task.cameras) {
    is_known = is_known && is_declared(other.camera, cameras_);
    out.add_id(other.camera);
    out.add(std::string_view(other.as ? other.as->text : ""));
  }
  add_object(task.source);
  add_object(task.target);
  out.add(std::uint64_t{task.others.size()});
  for (const Task::Filled& filled : task.others) {
    out.add_id(filled.role);
    // A role of which nothing speaks is told of where it is filled.
    out.add(std::uint64_t{is_within(filled.span, task.decl_span)});
    add_objects(filled.objects);
  }
  add_objects(task.distractors);
  add_objects(task.part_distractors);
  out.add(std::uint64_t{task.refer.size()});
  for (const auto& [role, phrase] : task.refer) {
    is_known = is_known && !spatial_.contains(phrase.text);
    out.add_id(role);
    out.add(std::string_view(phrase.text));
  }
  out.add(std::uint64_t{task.poses.size()});
  for (const PoseOverride& pose : task.poses) {
    add_object(pose.object);
    out.add(std::uint64_t{pose.turns.size()});
    for (const Turn& turn : pose.turns) {
      for (const double part : turn.rotation) out.add(part);
    }
  }
  out.add(std::uint64_t{task.joint_starts.size()});
  for (const JointStart& start : task.joint_starts) {
    out.add_id(start.fixture);
    out.add(std::uint64_t{start.joint});
    out.add(start.value);
  }
  out.add(task.horizon);
  out.add(task.horizon_time ? task.horizon_time->si() : 0.0);
  out.add(std::uint64_t{task.idle} << 32 | task.delay);
  out.add(std::uint64_t{task.allow_absent} << 1 | std::uint64_t{task.keeps_absent});
  return is_known ? out.key() : Key{};
}

const Remembered::Followed* Remembered::followed(const Model& model, std::uint32_t index,
                                                 const Task& task) {
  forget(index);
  const Key key = key_of(model, task);
  if (key.is_none()) return nullptr;
  keys_[index] = key;
  const auto at = followed_.find(key);
  if (at == followed_.end()) return nullptr;
  at->second.met = analysis_;
  return &at->second;
}

void Remembered::forget(std::uint32_t index) {
  if (index >= keys_.size()) keys_.resize(index + 1);
  keys_[index] = {};
}

void Remembered::keep(std::uint32_t index, const Task& task) {
  if (key_at(index).is_none()) return;
  followed_.insert_or_assign(keys_[index],
                             Followed{task.placed, task.prompt, task.ood, analysis_});
}

Remembered::Compared* Remembered::compared(const Key& task, const Key& baseline) {
  KeyMaker both;
  both.add(task);
  both.add(baseline);
  Compared& found = compared_[both.key()];
  found.met = analysis_;
  return &found;
}

std::optional<std::uint32_t> Remembered::axes(std::uint32_t index, std::uint32_t baseline) {
  const Key here = key_at(index), there = key_at(baseline);
  if (here.is_none() || there.is_none()) return std::nullopt;
  return compared(here, there)->axes;
}

void Remembered::keep_axes(std::uint32_t index, std::uint32_t baseline, std::uint32_t axes) {
  const Key here = key_at(index), there = key_at(baseline);
  if (!here.is_none() && !there.is_none()) compared(here, there)->axes = axes;
}

std::optional<Key> Remembered::choices_key(std::uint32_t index, std::string_view frame) const {
  const Key task = key_at(index);
  if (task.is_none()) return std::nullopt;
  KeyMaker out;
  out.add(task);
  out.add(frame);
  return out.key();
}

const std::vector<std::uint32_t>* Remembered::choices(std::uint32_t index, std::string_view frame) {
  const auto key = choices_key(index, frame);
  const auto at = key ? choices_.find(*key) : choices_.end();
  if (at == choices_.end()) return nullptr;
  at->second.second = analysis_;
  return &at->second.first;
}

void Remembered::keep_choices(std::uint32_t index, std::string_view frame,
                              std::vector<std::uint32_t> found) {
  if (const auto key = choices_key(index, frame))
    choices_.insert_or_assign(*key, std::pair(std::move(found), analysis_));
}

Key Remembered::starts_key(LayoutId layout, const std::vector<double>& made_of) const {
  KeyMaker out;
  out.add(made_of_);
  out.add(layouts_[static_cast<std::size_t>(layout)]);
  // The first is the layout's number.
  for (std::size_t i = 1; i < made_of.size(); ++i) out.add(made_of[i]);
  return out.key();
}

const std::vector<Start>* Remembered::starts(LayoutId layout, const std::vector<double>& made_of) {
  const auto at = starts_.find(starts_key(layout, made_of));
  if (at == starts_.end()) return nullptr;
  at->second.second = analysis_;
  return &at->second.first;
}

void Remembered::keep_starts(LayoutId layout, const std::vector<double>& made_of,
                             const std::vector<Start>& starts) {
  starts_.insert_or_assign(starts_key(layout, made_of), std::pair(starts, analysis_));
}

const robot::RobotModel* Remembered::described(const std::string& path) {
  const auto at = described_.find(path);
  return at == described_.end() || at->second.first != stamp_of(path) ? nullptr
                                                                      : &at->second.second;
}

void Remembered::keep_described(const std::string& path, const Key& stamp,
                                const robot::RobotModel& model) {
  described_.insert_or_assign(path, std::pair(stamp, model));
}

void Remembered::begin_checks(const Model& model) {
  checked_.assign(model.tasks.size(), nullptr);
  // The names of objects are what words are held against, all of them.
  if (model.objects.size() != objects_ || model.exprs.names_objects != names_objects_) return;
  for (std::size_t i = 0; i < model.tasks.size(); ++i) {
    const Task& task = model.tasks[model.tasks.id(i)];
    const Key here = key_at(i);
    if (here.is_none() || !task.complete) continue;
    const bool is_compared = task.baseline != TaskId::kNone;
    const Key there = is_compared ? key_at(static_cast<std::size_t>(task.baseline)) : made_of_;
    if (there.is_none() || (is_compared && !model.tasks[task.baseline].complete)) continue;
    checked_[i] = compared(here, there);
  }
}

bool Remembered::is_silent(std::size_t index, Silent check) const {
  return checked_[index] != nullptr &&
         (checked_[index]->silent >> static_cast<unsigned>(check) & 1) != 0;
}

void Remembered::keep_silent(std::size_t index, Silent check) {
  if (checked_[index] != nullptr)
    checked_[index]->silent |= 1u << static_cast<unsigned>(check);
}

bool Silence::is_known(const Task& task) {
  if (memory_ == nullptr) return false;
  end();
  index_ = static_cast<std::size_t>(&task - &*model_.tasks.begin());
  if (memory_->is_silent(index_, check_)) return true;
  before_ = reporter_.diagnostics.size();
  is_open_ = says_ == Says::kOfEach || before_ == first_;
  return false;
}

void Silence::end() {
  if (is_open_ && reporter_.diagnostics.size() == before_) memory_->keep_silent(index_, check_);
  is_open_ = false;
}

}  // namespace probe::sema
