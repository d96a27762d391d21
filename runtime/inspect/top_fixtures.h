// Fixtures with joints seen from above, and regions: where they are as an episode begins, and how
// far their parts come.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/inspect/top_view.h"

namespace probe::inspect {

// Adds the parts of the task's fixtures and the regions of surface, fixtures and parts; those of
// objects go where objects go. Fails as top_view().
Status add_fixtures(const plan::Plan& plan, const plan::TaskRecord& task,
                    const AssetRoot& asset_root, TopView* view);

}  // namespace probe::inspect
