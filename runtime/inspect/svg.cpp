#include "runtime/inspect/svg.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "runtime/base/trig.h"
#include "runtime/base/xml_text.h"

namespace probe::inspect {
namespace {

// Pixels of the page.
constexpr double kPlotWidth = 760, kPlotHeight = 720;  // at most
constexpr double kLeft = 56, kBottom = 48, kGap = 24, kLegend = 230;
constexpr double kTitleLine = 26;
constexpr double kMargin = 0.05;  // m around everything

constexpr std::string_view kTable = "#efe7da", kReach = "#2a8f57", kCamera = "#7d4aa8";
constexpr std::string_view kFixture = "#8c6d3f", kRegion = "#b3126e";
constexpr std::string_view kInk = "#222222", kFaint = "#666666";

std::string_view colour(Role role) {
  switch (role) {
    case Role::kSource:
      return "#d1560f";
    case Role::kTarget:
      return "#1664a5";
    case Role::kOther:
      return "#8a2f6b";
    case Role::kDistractor:
    case Role::kPlaced:
      return "#5f6b73";
  }
  return kInk;
}

// A tenth of a pixel is enough, and never a negative zero.
std::string px(double value) { return fmt::format("{}", std::nearbyint(value * 10) / 10 + 0.0); }
std::string cm(double metres) {
  return fmt::format("{}", std::nearbyint(metres * 1000) / 10 + 0.0);
}

std::vector<std::string> wrapped(std::string_view text, std::size_t columns) {
  std::vector<std::string> lines = {""};
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string word(text.substr(0, end));
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > columns)
      lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// "0-3, 8, 10-11"
std::string ranges(const std::vector<std::uint32_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", numbers[i]);
    if (last > i) text += fmt::format("-{}", numbers[last]);
    i = last + 1;
  }
  return text;
}

// The part of the world that is shown.
struct Window {
  double left, bottom, right, top;

  void include(const Point& p) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    bottom = std::min(bottom, p.y);
    top = std::max(top, p.y);
  }
  double width() const { return right - left; }
  double height() const { return top - bottom; }
};

class Page {
 public:
  explicit Page(const TopView& view)
      : view_(view), window_{view.area[0], view.area[1], view.area[2], view.area[3]} {
    window_.include(view.base);
    for (const Footprint& print : view.footprints) {
      for (const Point& corner : print.outline) window_.include(corner);
      for (const Point& corner : print.way) window_.include(corner);
    }
    for (const TopPart& part : view.parts) {
      for (const auto* outlines : {&part.outlines, &part.open}) {
        for (const auto& outline : *outlines) {
          for (const Point& corner : outline) window_.include(corner);
        }
      }
    }
    window_ = {window_.left - kMargin, window_.bottom - kMargin, window_.right + kMargin,
               window_.top + kMargin};
    scale_ = std::min(kPlotWidth / window_.width(), kPlotHeight / window_.height());
    plot_width_ = window_.width() * scale_;
    plot_height_ = window_.height() * scale_;
    width_ = kLeft + plot_width_ + kGap + kLegend;
    title_ = wrapped(view.prompt, static_cast<std::size_t>((width_ - kLeft) / 10.5));
    plot_top_ = 24 + kTitleLine * static_cast<double>(title_.size()) + 24;
    height_ = std::max(plot_top_ + plot_height_ + kBottom, plot_top_ + 330);
  }

  std::string draw() {
    open();
    titles();
    put("<clipPath id=\"plot\"><rect {}/></clipPath>\n", frame());
    put("<g clip-path=\"url(#plot)\">\n");
    table();
    reach();
    images();
    parts();
    regions();
    for (const Role role :
         {Role::kTarget, Role::kPlaced, Role::kDistractor, Role::kOther, Role::kSource})
      footprints(role);
    cells();
    markers();
    put("</g>\n");
    put("<rect {} fill=\"none\" stroke=\"{}\"/>\n", frame(), kFaint);
    ruler();
    scale_bar();
    left_and_right();
    legend();
    put("</svg>\n");
    return std::move(out_);
  }

 private:
  template <typename... Values>
  void put(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Values>(values)...);
  }
  double x(double metres) const { return kLeft + (metres - window_.left) * scale_; }
  double y(double metres) const { return plot_top_ + (window_.top - metres) * scale_; }
  std::string frame() const {
    return fmt::format("x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"", px(kLeft), px(plot_top_),
                       px(plot_width_), px(plot_height_));
  }
  std::string points(const std::vector<Point>& corners) const {
    std::string text;
    for (const Point& p : corners)
      text += fmt::format("{}{},{}", text.empty() ? "" : " ", px(x(p.x)), px(y(p.y)));
    return text;
  }
  void text(double at_x, double at_y, int size, std::string_view fill, std::string_view words,
            std::string_view more = "") {
    put("<text x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{}\"{}>{}</text>\n", px(at_x), px(at_y),
        size, fill, more, xml_text(words));
  }

  void open() {
    put("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
        "viewBox=\"0 0 {0} {1}\" font-family=\"Helvetica, Arial, sans-serif\"",
        px(width_), px(height_));
    // For programs that show it: the plot, and x px = zero x + scale * x m, y px = zero y - scale *
    // y m.
    put(" data-plot=\"{} {} {} {}\" data-scale=\"{}\" data-zero=\"{} {}\">\n", px(kLeft),
        px(plot_top_), px(plot_width_), px(plot_height_), scale_, x(0), y(0));
    put("<title>{}</title>\n", xml_text(view_.prompt));
    put("<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n", px(width_), px(height_));
  }

  void titles() {
    double line = 34;
    for (const std::string& words : title_) {
      text(kLeft, line, 20, kInk, words, " font-weight=\"bold\"");
      line += kTitleLine;
    }
    text(kLeft, line - 4, 13, kFaint,
         fmt::format("{}, {} starts, seen from above", view_.task, view_.starts));
  }

  void table() {
    put("<rect {} fill=\"#fbfbfa\"/>\n", frame());
    const auto& a = view_.area;
    put("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" stroke=\"#b9a98c\"/>\n",
        px(x(a[0])), px(y(a[3])), px((a[2] - a[0]) * scale_), px((a[3] - a[1]) * scale_), kTable);
  }

  // What is out of reach is shaded: all of the plot but the annulus.
  void reach() {
    const auto circle = [&](double radius) {
      return fmt::format("M{} {}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 {} 0z",
                         px(x(view_.base.x) - radius * scale_), px(y(view_.base.y)),
                         px(2 * radius * scale_), px(-2 * radius * scale_),
                         fmt::arg("r", px(radius * scale_)));
    };
    const std::string inner = view_.reach_min > 0 ? circle(view_.reach_min) : "";
    put("<path d=\"M{} {}h{}v{}h{}z{}\" fill=\"#000000\" fill-opacity=\"0.1\" "
        "fill-rule=\"evenodd\"/>\n",
        px(kLeft), px(plot_top_), px(plot_width_), px(plot_height_), px(-plot_width_),
        circle(view_.reach_max));
    if (!inner.empty()) put("<path d=\"{}\" fill=\"#000000\" fill-opacity=\"0.1\"/>\n", inner);
    put("<path d=\"{}{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n",
        circle(view_.reach_max), inner, kReach);
  }

  void images() {
    for (const TopCamera& camera : view_.cameras) {
      if (camera.image.empty()) continue;
      put("<polygon points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" "
          "stroke-dasharray=\"8 5\"/>\n",
          points(camera.image), kCamera);
    }
  }

  // Solid where they begin in the first start, dashed where their joint ends, faint where others
  // begin.
  void parts() {
    for (const TopPart& part : view_.parts) {
      put("<g stroke=\"{0}\"><title>{1}{2}</title>\n", kFixture, xml_text(part.name),
          part.starts.empty() ? "" : ": starts " + ranges(part.starts));
      for (const auto& outline : part.outlines) {
        put("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.18\"/>\n", points(outline),
            kFixture);
      }
      for (const auto& outline : part.open)
        put("<polygon points=\"{}\" fill=\"none\" stroke-dasharray=\"3 3\"/>\n", points(outline));
      put("</g>\n");
      for (const TopPart::Begun& other : part.others) {
        put("<g stroke=\"{0}\" stroke-opacity=\"0.6\"><title>{1}: starts {2}</title>\n", kFixture,
            xml_text(part.name), ranges(other.starts));
        for (const auto& outline : other.outlines)
          put("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.06\"/>\n", points(outline),
              kFixture);
        put("</g>\n");
      }
    }
  }

  void regions() {
    for (const TopRegion& region : view_.regions) {
      put("<g><title>{}{}</title><polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.06\" "
          "stroke=\"{}\" stroke-dasharray=\"1 3\" stroke-width=\"2\"/></g>\n",
          xml_text(region.name), region.starts.empty() ? "" : ": starts " + ranges(region.starts),
          points(region.outline), kRegion, kRegion);
    }
  }

  void cells() {
    for (const Point& cell : view_.cells) {
      put("<path d=\"M{} {}h14m-7 -7v14\" stroke=\"{}\" stroke-width=\"1\"/>\n", px(x(cell.x) - 7),
          px(y(cell.y)), kInk);
    }
  }

  void footprints(Role role) {
    for (const Footprint& print : view_.footprints) {
      if (print.role != role) continue;
      put("<g data-object=\"{}\" data-at=\"{} {}\" data-starts=\"{}\" ", xml_text(print.object),
          print.at.x, print.at.y, fmt::join(print.starts, " "));
      put("fill=\"{0}\" stroke=\"{0}\"><title>{1} at ({2}, {3}) cm, yaw {4} deg{6}: starts "
          "{5}</title>\n",
          colour(role), xml_text(print.object), cm(print.at.x), cm(print.at.y),
          fmt::format("{}", std::nearbyint(print.yaw_deg * 10) / 10 + 0.0), ranges(print.starts),
          print.moves.empty() ? "" : ", moves " + print.moves);
      put("<polygon points=\"{}\" fill-opacity=\"0.12\" stroke-width=\"1.3\" "
          "stroke-opacity=\"0.75\"/>\n",
          points(print.outline));
      yaw_arrow(print);
      way(print);
      put("</g>\n");
    }
  }

  // From the origin along the object's x axis, as far as its outline reaches.
  void yaw_arrow(const Footprint& print) {
    const auto [sin, cos] = portable_sincos_deg(print.yaw_deg);
    double length = 0;
    for (const Point& corner : print.outline) {
      length = std::max(length, (corner.x - print.at.x) * cos + (corner.y - print.at.y) * sin);
    }
    const double from_x = x(print.at.x), from_y = y(print.at.y);
    const double to_x = from_x + length * scale_ * cos, to_y = from_y - length * scale_ * sin;
    const double back_x = to_x - 7 * cos, back_y = to_y + 7 * sin;
    put("<path d=\"M{} {}L{} {}\" stroke-width=\"1.3\"/>", px(from_x), px(from_y), px(back_x),
        px(back_y));
    put("<polygon points=\"{},{} {},{} {},{}\" stroke=\"none\"/>\n", px(to_x), px(to_y),
        px(back_x - 3.5 * sin), px(back_y - 3.5 * cos), px(back_x + 3.5 * sin),
        px(back_y + 3.5 * cos));
  }

  // Where it goes by itself, dashed, and an arrow's head where the first leg ends.
  void way(const Footprint& print) {
    if (print.way.size() < 2) return;
    std::string path;
    for (const Point& corner : print.way)
      path += fmt::format("{}{} {}", path.empty() ? "M" : "L", px(x(corner.x)), px(y(corner.y)));
    put("<path d=\"{}\" fill=\"none\" stroke-width=\"1.6\" stroke-dasharray=\"6 4\"/>\n", path);
    const Point &from = print.way[0], &to = print.way[1];
    const double along_x = to.x - from.x, along_y = to.y - from.y;
    const double length = std::sqrt(along_x * along_x + along_y * along_y);
    const double cos = along_x / length, sin = along_y / length;
    const double back_x = x(to.x) - 9 * cos, back_y = y(to.y) + 9 * sin;
    put("<polygon points=\"{},{} {},{} {},{}\" stroke=\"none\"/>\n", px(x(to.x)), px(y(to.y)),
        px(back_x - 4 * sin), px(back_y - 4 * cos), px(back_x + 4 * sin), px(back_y + 4 * cos));
  }

  void markers() {
    const auto [sin, cos] = portable_sincos_deg(view_.base_yaw_deg);
    put("<path d=\"M{} {}L{} {}\" stroke=\"{}\" stroke-width=\"3\"/>\n", px(x(view_.base.x)),
        px(y(view_.base.y)), px(x(view_.base.x) + 24 * cos), px(y(view_.base.y) - 24 * sin), kInk);
    base_mark(x(view_.base.x), y(view_.base.y));
    for (const TopCamera& camera : view_.cameras) eye_mark(x(camera.eye.x), y(camera.eye.y));
  }
  void base_mark(double at_x, double at_y) {
    put("<circle cx=\"{}\" cy=\"{}\" r=\"9\" fill=\"{}\"/>\n", px(at_x), px(at_y), kInk);
  }
  void eye_mark(double at_x, double at_y) {
    put("<circle cx=\"{0}\" cy=\"{1}\" r=\"6\" fill=\"#ffffff\" stroke=\"{2}\" "
        "stroke-width=\"2.5\"/>\n",
        px(at_x), px(at_y), kCamera);
  }

  // Centimetres along the lower and left edge.
  void ruler() {
    const double step = window_.width() > 2 ? 0.5 : 0.1;
    const double low = plot_top_ + plot_height_;
    for (double k = std::ceil(window_.left / step); k * step <= window_.right; ++k) {
      put("<path d=\"M{} {}v5\" stroke=\"{}\"/>", px(x(k * step)), px(low), kFaint);
      text(x(k * step), low + 19, 12, kFaint, cm(k * step), " text-anchor=\"middle\"");
    }
    for (double k = std::ceil(window_.bottom / step); k * step <= window_.top; ++k) {
      put("<path d=\"M{} {}h-5\" stroke=\"{}\"/>", px(kLeft), px(y(k * step)), kFaint);
      text(kLeft - 9, y(k * step) + 4, 12, kFaint, cm(k * step), " text-anchor=\"end\"");
    }
    text(kLeft + plot_width_ / 2, low + 38, 12, kFaint, "x of the world, cm",
         " text-anchor=\"middle\"");
    text(16, plot_top_ + plot_height_ / 2, 12, kFaint, "y of the world, cm",
         fmt::format(" text-anchor=\"middle\" transform=\"rotate(-90 16 {})\"",
                     px(plot_top_ + plot_height_ / 2)));
  }

  void scale_bar() {
    const double left = kLeft + 14, low = plot_top_ + plot_height_ - 14;
    put("<path d=\"M{} {}v-8m0 4h{}m0 -4v8\" stroke=\"{}\" stroke-width=\"2\" fill=\"none\"/>\n",
        px(left), px(low), px(0.1 * scale_), kInk);
    text(left + 0.05 * scale_, low - 10, 12, kInk, "10 cm", " text-anchor=\"middle\"");
  }

  // Which way is left and which right in the first picture.
  void left_and_right() {
    if (view_.cameras.empty()) return;
    const Point& right = view_.cameras[0].right;
    if (right.x == 0 && right.y == 0) return;
    constexpr double kArm = 26, kWord = 40;
    const double at_x = kLeft + plot_width_ - 66, at_y = plot_top_ + 56;
    put("<path d=\"M{} {}L{} {}\" stroke=\"{}\" stroke-width=\"2\"/>\n", px(at_x - kArm * right.x),
        px(at_y + kArm * right.y), px(at_x + kArm * right.x), px(at_y - kArm * right.y), kCamera);
    for (const double side : {-1.0, 1.0}) {
      text(at_x + side * kWord * right.x, at_y - side * kWord * right.y + 4, 12, kCamera,
           side < 0 ? "left" : "right", " text-anchor=\"middle\"");
    }
  }

  void legend() {
    const double left = kLeft + plot_width_ + kGap;
    double line = plot_top_ + 14;
    const auto say = [&](std::string_view words, std::string_view fill = kInk) {
      for (const std::string& part : wrapped(words, 28)) {
        text(left + 34, line, 13, fill, part);
        line += 18;
      }
      line += 8;
    };
    const auto objects = [&](Role role, const std::string& name,
                             const std::vector<std::string>& names) {
      if (names.empty()) return;
      put("<rect x=\"{0}\" y=\"{1}\" width=\"24\" height=\"12\" fill=\"{2}\" "
          "fill-opacity=\"0.25\" stroke=\"{2}\"/>\n",
          px(left), px(line - 11), colour(role));
      std::string words = name;
      for (std::size_t i = 0; i < names.size(); ++i) words += (i == 0 ? ": " : ", ") + names[i];
      say(words);
    };
    objects(Role::kSource, "source", view_.sources);
    objects(Role::kTarget, "target", view_.targets);
    for (const TopView::NamedRole& other : view_.others) {
      if (!other.role.empty()) objects(Role::kOther, other.role, other.objects);
    }
    objects(Role::kDistractor, "distractors", view_.distractors);
    for (const TopView::NamedRole& other : view_.others) {
      if (other.role.empty()) objects(Role::kPlaced, "placed", other.objects);
    }
    const auto stroke = [&](std::string_view path, std::string_view more, std::string_view fill) {
      put("<path d=\"M{} {}{}\" stroke=\"{}\"{} fill=\"none\"/>\n", px(left), px(line - 5), path,
          fill, more);
    };
    stroke("h20m-5 -4l5 4l-5 4", " stroke-width=\"1.3\"", kInk);
    say("x axis of an object: its yaw");
    std::vector<std::string> told;  // each thing that moves once, however often it stands
    for (const Footprint& print : view_.footprints) {
      if (print.moves.empty() || std::ranges::find(told, print.object) != told.end()) continue;
      stroke("h24", " stroke-width=\"1.6\" stroke-dasharray=\"6 4\"", kInk);
      say(print.object + " moves " + print.moves);
      told.push_back(print.object);
    }
    stroke("m5 0h14m-7 -7v14", "", kInk);
    say("cell: where origins stand");
    stroke("h24", " stroke-width=\"1.5\"", kReach);
    say(fmt::format("reach of {}: {} to {} cm from its base; shaded: outside", view_.robot,
                    cm(view_.reach_min), cm(view_.reach_max)));
    if (!view_.parts.empty()) {
      stroke("h24", " stroke-width=\"1.5\"", kFixture);
      say("fixtures: where their joints start; dashed, where they end");
    }
    for (std::size_t i = 0; i < view_.regions.size(); ++i) {
      // Once, wherever starts have it.
      if (i > 0 && view_.regions[i].name == view_.regions[i - 1].name) continue;
      stroke("h24", " stroke-width=\"2\" stroke-dasharray=\"1 3\"", kRegion);
      say("region " + view_.regions[i].name);
    }
    for (const TopCamera& camera : view_.cameras) {
      if (camera.image.empty()) continue;
      stroke("h24", " stroke-width=\"1.5\" stroke-dasharray=\"8 5\"", kCamera);
      say(fmt::format("what {} sees of the table's plane", camera.name));
    }
    if (!view_.cameras.empty() && (view_.cameras[0].right.x != 0 || view_.cameras[0].right.y != 0))
      say("left and right: as " + view_.cameras[0].name + " sees it", kCamera);
    base_mark(left + 12, line - 5);
    say("base of the robot, turned as it stands");
    for (const TopCamera& camera : view_.cameras) {
      eye_mark(left + 12, line - 5);
      say(fmt::format("camera {}", camera.name));
    }
    line += 4;
    for (const std::string& part : wrapped("Every different way in which an object stands is drawn "
                                           "once; point at it for its starts.",
                                           34)) {
      text(left, line, 12, kFaint, part);
      line += 16;
    }
  }

  const TopView& view_;
  Window window_;
  std::string out_;
  std::vector<std::string> title_;
  double scale_ = 1, plot_width_ = 0, plot_height_ = 0, plot_top_ = 0, width_ = 0, height_ = 0;
};

}  // namespace

std::string to_svg(const TopView& view) { return Page(view).draw(); }

}  // namespace probe::inspect
