// The report as a whole: folders of runs and answers, tables of others, floors, and a page.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/report/benchmark.h"
#include "runtime/report/episode_documents.h"
#include "runtime/report/page_data.h"
#include "runtime/report/tables.h"

namespace probe::report {

struct ReportRequest {
  std::vector<std::string> dirs;
  std::vector<std::string> sets = {};       // of the plan that are the columns; empty: its finest
  std::vector<std::string> published = {};  // CSV of other people's percentages
  std::string floors = {};                  // CSV of floors and ceilings measured before
  std::string title = {};
  std::string command = {}, program = {};  // what the page says made it
  std::string out = {};  // where the page will lie: folders and videos are written from there
  bool traces = true;    // false: no timelines and no explained verdicts
  int jobs = 0;          // threads that read traces; 0: one a core
};

struct LoadedReport {
  Benchmark benchmark;
  Tables tables;
  PageOptions options;
};

// What tables need. Fails as load(), read_published() and add_floors() do.
Result<LoadedReport> load_report(const ReportRequest& request);
// What was done in the episodes; adds the tables of events. A note says where none are told.
EpisodeDocuments read_episodes(LoadedReport& report, const ReportRequest& request);
// The page; adds the notes of the traces that could not be read.
std::string page_text(LoadedReport& report, EpisodeDocuments episodes);

}  // namespace probe::report
