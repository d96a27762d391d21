#include "compiler/check/unclear_starts.h"

#include "compiler/define/fixture.h"
#include "compiler/define/thing.h"
#include "compiler/define/views.h"

namespace probe::sema {

const Unclear& UnclearStarts::find(const Task& task, const Phrase& phrase, ObjectId wanted) {
  std::vector<std::pair<RoleId, ObjectId>> filled;
  for (const ObjectId id : task.objects()) filled.emplace_back(task.role_of(id), id);
  for (const auto& [role, id] : things_of(task)) filled.emplace_back(role, id);
  std::vector<double> joints;
  if (!model_.scenes[task.scene].fixtures.empty()) joints = joint_starts_in_all(model_, task);
  Key key(task.starts.data(), task.starts.size(), task.scene, views_of(model_, task).front().camera,
          &phrase, wanted, std::move(filled), std::move(joints));
  const auto [at, is_new] = known_.try_emplace(std::move(key));
  if (!is_new) return at->second;
  Unclear& found = at->second;
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    const Denotation meant = InStart(relations_, task, task.starts[i]).denote(phrase, wanted);
    if (meant.is_clear()) continue;
    auto& kind = !meant.may_fit       ? found.unfit
                 : meant.sure.empty() ? found.unknown
                                      : found.ambiguous;
    kind.push_back(i);
  }
  return found;
}

}  // namespace probe::sema
