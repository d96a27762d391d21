// The first pictures of the cases that a search has found, and of the task itself, drawn from the
// plan of the round that confirmed them.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/report/search_findings.h"

namespace probe::report {

struct CasePicture {
  std::string instruction;
  std::string png;       // bytes of the file
  bool is_first = true;  // of the task's first start; else of the first that is fair
};

struct CasePictures {
  CasePicture base;
  std::vector<CasePicture> cases;  // by number of the case; without `png` where it is not confirmed
  std::string note;                // why there are none: then `base` has no picture
};

// Of a search of `worst`. `width`: of a picture, in pixels. Assets as find_asset_root takes them.
CasePictures pictures_of(const SearchFindings& found, const AssetRoot& assets, int width = 480);

}  // namespace probe::report
