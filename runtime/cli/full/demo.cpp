// vlaprobe demo: the other verbs one after the other, each as one would type it.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "runtime/base/inside.h"
#include "runtime/base/own_folder.h"
#include "runtime/base/say.h"
#include "runtime/base/shell_word.h"
#include "runtime/cli/app.h"
#include "runtime/cli/full/add_all.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

namespace fs = std::filesystem;

constexpr char kTask[] = "carrot_on_plate";

struct Step {
  const char* what;
  std::vector<std::string> words;
};

std::vector<Step> steps(const std::string& suite, const std::string& out) {
  const auto run = [&](const char* policy) {
    return std::vector<std::string>{"run",      suite,     "--tasks", kTask,  "--episodes", "0-3",
                                    "--policy", policy,    "--video", "all",  "--jobs",     "2",
                                    "-o",       out + "/" + policy};
  };
  return {{"The text is checked: words, comparisons, reach.", {"check", suite}},
          {"A policy that sees everything solves four starts ...", run("expert")},
          {"... and one that goes there and never closes its fingers does not.", run("reach")},
          {"Why? By source line and measured number.", {"why", out + "/reach", kTask, "0"}},
          {"Both on one page that opens from disk.",
           {"report", out + "/expert", out + "/reach", "-o", out + "/report.html"}}};
}

int run_step(const Step& step) {
  std::string line = "vlaprobe";
  for (const std::string& word : step.words) line += " " + shell_word(word);
  put("\n{}\n$ {}\n", step.what, line);
  std::fflush(stdout);  // what steps say of themselves goes to stderr
  std::vector<std::string> words = step.words;
  std::string name = "vlaprobe";
  std::vector<char*> arguments = {name.data()};
  for (std::string& word : words) arguments.push_back(word.data());
  return run_program(static_cast<int>(arguments.size()), arguments.data(), add_all_verbs, true);
}

int demonstrate(const std::string& out) {
  std::string suite;
  for (const fs::path& place : own_places("suite/intact.probe")) {
    std::error_code error;
    if (suite.empty() && fs::is_regular_file(place, error)) suite = place.string();
  }
  if (suite.empty())
    return report({Fault::kIo, "is not beside the program", "suite/intact.probe"});
  for (const char* const run : {"expert", "reach"}) {
    if (const auto own = check_inside(out, run); !own) return report(own.failure());
  }
  if (const auto page = file_inside(out, "report.html"); !page) return report(page.failure());
  for (const Step& step : steps(suite, out)) {
    if (const int exit = run_step(step); exit != kFine) return exit;
  }
  put("\n{0}/report.html opens in a browser; {0}/expert/videos are videos.\n"
      "Your own task: copy {1} and change it. Your own policy: vlaprobe policy --help.\n",
      out, suite);
  return kFine;
}

}  // namespace

void add_demo(Verb app, int& exit) {
  auto out = std::make_shared<std::string>("vlaprobe-demo");
  Verb verb = app.add_subcommand("demo", "a task, its episodes, a video and a report in ten seconds");
  verb.footer("every step is a command that you can type\nexample: vlaprobe demo -o demo");
  verb.add_option("-o,--out", *out, "folder to write (default: vlaprobe-demo)");
  verb.refuse_empty_values();
  verb.callback([out, &exit] { exit = demonstrate(*out); });
}

}  // namespace probe::cli
