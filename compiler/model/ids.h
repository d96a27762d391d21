// Distinct index types for the tables of the model, so that a task cannot be looked up among
// objects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace probe::sema {

enum class DatasetId : std::uint32_t { kNone = 0xffffffffu };
enum class AttributeId : std::uint32_t { kNone = 0xffffffffu };
enum class ObjectId : std::uint32_t { kNone = 0xffffffffu };
enum class RobotId : std::uint32_t { kNone = 0xffffffffu };
enum class CameraId : std::uint32_t { kNone = 0xffffffffu };
enum class LightId : std::uint32_t { kNone = 0xffffffffu };
enum class FixtureId : std::uint32_t { kNone = 0xffffffffu };
enum class SceneId : std::uint32_t { kNone = 0xffffffffu };
enum class LayoutId : std::uint32_t { kNone = 0xffffffffu };
enum class TemplateId : std::uint32_t { kNone = 0xffffffffu };
enum class PredicateId : std::uint32_t { kNone = 0xffffffffu };
enum class MetricsId : std::uint32_t { kNone = 0xffffffffu };
// The first two are there in every text; others are declared, and their objects follow those two.
enum class RoleId : std::uint32_t { kSource = 0, kTarget = 1, kNone = 0xffffffffu };
enum class TaskId : std::uint32_t { kNone = 0xffffffffu };
enum class SetId : std::uint32_t { kNone = 0xffffffffu };
enum class SuiteId : std::uint32_t { kNone = 0xffffffffu };
enum class QuestionSetId : std::uint32_t { kNone = 0xffffffffu };

// A vector indexed by its id type.
template <typename Id, typename T>
class Table {
 public:
  T& operator[](Id id) { return rows_[static_cast<std::size_t>(id)]; }
  const T& operator[](Id id) const { return rows_[static_cast<std::size_t>(id)]; }
  Id add(T row) {
    rows_.push_back(std::move(row));
    return static_cast<Id>(rows_.size() - 1);
  }
  void drop_last() { rows_.pop_back(); }
  std::size_t size() const { return rows_.size(); }
  Id id(std::size_t index) const { return static_cast<Id>(index); }
  auto begin() { return rows_.begin(); }
  auto end() { return rows_.end(); }
  auto begin() const { return rows_.begin(); }
  auto end() const { return rows_.end(); }

 private:
  std::vector<T> rows_;
};

}  // namespace probe::sema
