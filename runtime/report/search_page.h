// The report of searches: where policies break, as one page that needs no script, and as data.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/report/search_findings.h"

namespace probe::report {

struct SearchPageOptions {
  std::string title = {};
  std::string command = {}, program = {};  // what the page says made it
  AssetRoot assets = {};                   // of the pictures; empty: found by itself
};

// Whether the folders are searches. Fails (kUsage) naming one that is a search and one that is not.
Result<bool> are_searches(const std::vector<std::string>& dirs);

// A folder that is named twice counts once. Fails as read_findings does.
Result<std::vector<SearchFindings>> load_searches(const std::vector<std::string>& dirs);

struct SearchPage {
  std::string html;
  std::vector<std::string> notes;  // what the page lacks, and why
};
SearchPage search_page(std::span<const SearchFindings> searches, const SearchPageOptions& options);

// "vlaprobe-search-report": of each search its folder, its search.json and what was left out.
Json search_page_json(std::span<const SearchFindings> searches, const SearchPageOptions& options);

}  // namespace probe::report
