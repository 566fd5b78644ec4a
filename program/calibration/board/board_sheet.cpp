#include "calibration/board/board_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

#include "calibration/board/board_drawing.h"
#include "ldso/error.h"

namespace ldso {
namespace {

constexpr double kMargin = 8;   // that printers leave white [mm]
constexpr double kFooter = 9;   // below the board, for the text [mm]
constexpr double kRuler = 100;  // [mm]
constexpr double kLeastPaper = 50, kMostPaper = 5000;

struct NamedPaper {
  const char* name;
  Paper paper;
};
constexpr std::array<NamedPaper, 7> kPapers{{{"a4", {210, 297}},
                                             {"a3", {297, 420}},
                                             {"a2", {420, 594}},
                                             {"a1", {594, 841}},
                                             {"a0", {841, 1189}},
                                             {"letter", {215.9, 279.4}},
                                             {"tabloid", {279.4, 431.8}}}};

/// Where things are on the page [mm], from its upper left.
struct Page {
  double width = 0, height = 0;
  Eigen::Vector2d origin;  ///< Of the board's coordinates.
  BoardDrawing drawing;
};

std::string millimetres(double value) {
  std::ostringstream out;
  out.precision(8);
  out << value;
  return out.str();
}

/// Upright or turned, as the board fits; nothing if it does not.
std::optional<Page> try_page(const Board& board, const Paper& paper) {
  Page page;
  page.drawing = draw_board(board);
  const Eigen::Vector2d size = 1000 * (page.drawing.lower_right - page.drawing.upper_left);
  for (const bool turned : {size.x() > size.y(), size.x() <= size.y()}) {
    page.width = turned ? paper.height : paper.width;
    page.height = turned ? paper.width : paper.height;
    const Eigen::Vector2d room(page.width - 2 * kMargin - size.x(), page.height - 2 * kMargin - kFooter - size.y());
    if (room.minCoeff() < -1e-6) continue;
    page.origin = Eigen::Vector2d::Constant(kMargin) + 0.5 * room - 1000 * page.drawing.upper_left;
    return page;
  }
  return std::nullopt;
}

Page page_of(const Board& board, const Paper& paper) {
  if (auto page = try_page(board, paper)) return *page;
  const BoardDrawing drawing = draw_board(board);
  const Eigen::Vector2d size = 1000 * (drawing.lower_right - drawing.upper_left);
  throw Error(board_text(board),
              "is " + millimetres(std::ceil(size.x())) + " x " + millimetres(std::ceil(size.y())) +
                  " mm with its margin, and does not fit on paper of " + millimetres(paper.width) + " x " +
                  millimetres(paper.height) + " mm",
              "take a larger --paper, smaller squares, or leave the size out: then it fills the paper");
}

std::string footer_text(const Board& board) {
  return "ldso calibrate --board " + board_text(board) + "   print at 100 %: the line is 100 mm";
}

/// Begins on a ruler of 100 mm if there is room for it beside the text.
double ruler_end(const Page& page) { return std::min(page.width - kMargin, kMargin + kRuler); }

}  // namespace

Paper parse_paper(const std::string& text, const std::string& where) {
  for (const NamedPaper& named : kPapers) {
    if (text == named.name) return named.paper;
  }
  Paper paper;
  char rest = 0;
  const auto is_side = [](double mm) { return mm >= kLeastPaper && mm <= kMostPaper; };
  if (std::sscanf(text.c_str(), "%lfx%lf%c", &paper.width, &paper.height, &rest) != 2 || !is_side(paper.width) ||
      !is_side(paper.height))
    throw Error(where, "'" + text + "' is no paper",
                "write a4, a3, a2, a1, a0, letter, tabloid or the sides in millimetres, as in 300x420 (50 to 5000)");
  if (paper.width > paper.height) std::swap(paper.width, paper.height);
  return paper;
}

std::string board_svg(const Board& board, const Paper& paper) {
  const Page page = page_of(board, paper);
  std::ostringstream out;
  out.precision(8);
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << page.width << "mm\" height=\"" << page.height
      << "mm\" viewBox=\"0 0 " << page.width << ' ' << page.height << "\">\n<rect width=\"100%\" height=\"100%\" "
      << "fill=\"white\"/>\n<g shape-rendering=\"crispEdges\">\n";
  for (const DrawnRectangle& r : page.drawing.rectangles) {
    const Eigen::Vector2d at = page.origin + 1000 * r.corner;
    out << "<rect x=\"" << at.x() << "\" y=\"" << at.y() << "\" width=\"" << 1000 * r.size.x() << "\" height=\""
        << 1000 * r.size.y() << "\"/>\n";
  }
  out << "</g>\n";
  for (const DrawnDisk& d : page.drawing.disks) {
    const Eigen::Vector2d at = page.origin + 1000 * d.centre;
    out << "<circle cx=\"" << at.x() << "\" cy=\"" << at.y() << "\" r=\"" << 1000 * d.radius << "\"/>\n";
  }
  const double foot = page.height - kMargin;
  out << "<rect x=\"" << kMargin << "\" y=\"" << foot - 0.3 << "\" width=\"" << ruler_end(page) - kMargin
      << "\" height=\"0.3\" fill=\"#888\"/>\n<text x=\"" << kMargin << "\" y=\"" << foot - 1.5
      << "\" font-family=\"sans-serif\" font-size=\"3\" fill=\"#888\">" << footer_text(board) << "</text>\n</svg>\n";
  return out.str();
}

namespace {

/// Four cubic curves; PDF has no circles.
void add_disk(std::ostringstream& out, const Eigen::Vector2d& c, double r) {
  constexpr double kBend = 0.5522847498;
  const double k = kBend * r;
  out << c.x() + r << ' ' << c.y() << " m\n";
  const std::array<Eigen::Vector2d, 4> axes{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d &a = axes[i], &b = axes[(i + 1) % 4];
    const Eigen::Vector2d p = c + r * a + k * b, q = c + r * b + k * a, end = c + r * b;
    out << p.x() << ' ' << p.y() << ' ' << q.x() << ' ' << q.y() << ' ' << end.x() << ' ' << end.y() << " c\n";
  }
  out << "f\n";
}

/// Drawn in millimetres from the lower left.
std::string pdf_content(const Board& board, const Page& page) {
  std::ostringstream out;
  out.precision(8);
  constexpr double kPointsPerMillimetre = 72 / 25.4;
  out << kPointsPerMillimetre << " 0 0 " << kPointsPerMillimetre << " 0 0 cm\n0 g\n";
  for (const DrawnRectangle& r : page.drawing.rectangles) {
    const Eigen::Vector2d at = page.origin + 1000 * r.corner, size = 1000 * r.size;
    out << at.x() << ' ' << page.height - at.y() - size.y() << ' ' << size.x() << ' ' << size.y() << " re\n";
  }
  if (!page.drawing.rectangles.empty()) out << "f\n";
  for (const DrawnDisk& d : page.drawing.disks) {
    const Eigen::Vector2d at = page.origin + 1000 * d.centre;
    add_disk(out, {at.x(), page.height - at.y()}, 1000 * d.radius);
  }
  out << "0.5 g\n"
      << kMargin << ' ' << kMargin << ' ' << ruler_end(page) - kMargin << " 0.3 re f\n"
      << "BT /F1 3 Tf " << kMargin << ' ' << kMargin + 1.5 << " Td (" << footer_text(board) << ") Tj ET\n";
  return out.str();
}

}  // namespace

std::string board_pdf(const Board& board, const Paper& paper) {
  const Page page = page_of(board, paper);
  const std::string content = pdf_content(board, page);
  const auto points = [](double mm) { return millimetres(mm * 72 / 25.4); };
  const std::vector<std::string> objects{
      "<< /Type /Catalog /Pages 2 0 R >>", "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + points(page.width) + " " + points(page.height) +
          "] /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> >> >>",
      "<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "endstream",
      "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>"};
  std::string pdf = "%PDF-1.4\n", table;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    std::array<char, 32> entry{};
    std::snprintf(entry.data(), entry.size(), "%010zu 00000 n \n", pdf.size());
    table += entry.data();
    pdf += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
  }
  const std::string start = std::to_string(pdf.size()), count = std::to_string(objects.size() + 1);
  return pdf + "xref\n0 " + count + "\n0000000000 65535 f \n" + table + "trailer\n<< /Size " + count +
         " /Root 1 0 R >>\nstartxref\n" + start + "\n%%EOF\n";
}

Board fitted_to(const Board& board, const Paper& paper) {
  constexpr double kStep = 0.0005;
  const double share = board.kind == BoardKind::kCharuco ? board.extra / board.size : 1;
  Board fitted = board, best = board;
  bool fits = false;
  for (int steps = 4; steps * kStep < 1; ++steps) {
    fitted.size = std::round(1e5 * steps * kStep) / 1e5;
    if (board.kind == BoardKind::kCharuco) fitted.extra = std::round(1e5 * share * fitted.size) / 1e5;
    if (!try_page(fitted, paper)) break;
    best = fitted;
    fits = true;
  }
  if (!fits) page_of(fitted, paper);  // Says that it does not fit.
  return best;
}

}  // namespace ldso
