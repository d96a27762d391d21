#include "runtime/search/proofs.h"

#include <utility>

namespace probe::search {

std::vector<PlannedPoint> with_proofs(const sema::Space& space, std::vector<space::Point> points) {
  const std::vector<double> own = space::own_values(space);
  std::vector<PlannedPoint> planned, proofs;
  for (space::Point& point : points) {
    PlannedPoint one{std::move(point), {}, {}, {}, kBase};
    const std::vector<double> placed = space::placed_values(space, one.point.values);
    if (placed == one.point.values && placed != own) {
      one.proof = planned.size();
    } else if (placed != own) {
      one.proof = points.size() + proofs.size();
      space::Point proof = one.point;
      proof.name += "_placed";
      proof.values = placed;
      proofs.push_back({std::move(proof), {}, {}, {}, one.proof});
    }
    planned.push_back(std::move(one));
  }
  planned.insert(planned.end(), proofs.begin(), proofs.end());
  return planned;
}

}  // namespace probe::search
