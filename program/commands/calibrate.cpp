#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calibration/board/board_sheet.h"
#include "calibration/lens/advice.h"
#include "calibration/lens/calibration_pictures.h"
#include "calibration/lens/calibration_report.h"
#include "calibration/lens/view_search.h"
#include "camera/camera_stream.h"
#include "commands/calibrate_commands.h"
#include "commands/commands.h"
#include "io/images/image_file.h"
#include "io/text/json_text.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"
#include "output/run_files.h"
#include "terminal/option_checks.h"
#include "terminal/progress_bar.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBoardForms =
    "chessboard:9x6:0.025 (inner corners, side of a square in metres), charuco:8x6:0.03:0.021:5x5_100 (squares, their "
    "side, that of the markers, dictionary), aprilgrid:6x6:0.03:0.3:36h11 (tags, their side, the gap between them as a "
    "part of it, family; as Kalibr has them), circles:4x11:0.02 (asymmetric: circles in a row, rows, distance of "
    "rows); "
    "what is left out at the end is as `ldso calibrate board` draws it";
/// To which the images are rectified by the camera.txt that is written: larger ones cost time for hardly more accuracy.
constexpr int kWorkingSide = 800;

struct LensArguments {
  fs::path sequence, out;
  std::string board, model = "auto";
  DatasetOptions dataset;
  int views = 60;
  bool json = false;
};

struct SheetArguments {
  std::string board, paper = "a4";
  fs::path out;
};

std::vector<std::string> model_names() {
  std::vector<std::string> names{"auto"};
  for (const LensKind kind : kLensKinds) names.push_back(lens_name(kind));
  return names;
}

OutputFolder open_calibration_folder(const LensArguments& a) {
  refuse_output_in_input(a.out, a.sequence, {});
  OutputFolder out(a.out);
  out.check({"camera.txt", "calibration.json", "coverage.png", "residuals.png"});
  return out;
}

LensCalibration calibrate(const LensArguments& a, const ViewSearch& found, const Board& board,
                          std::vector<LensCalibration>& others) {
  const std::string where = a.sequence.lexically_normal().string();
  if (a.model == "auto") return calibrate_best_lens(found.views, board, found.width, found.height, where, &others);
  for (const LensKind kind : kLensKinds) {
    if (lens_name(kind) == a.model) return calibrate_lens(found.views, board, kind, found.width, found.height, where);
  }
  throw Error("--model", "there is no model '" + a.model + "'", "see `ldso calibrate --help`");
}

void write_results(OutputFolder& out, const LensCalibration& lens, const std::string& json) {
  write_file(out.file("calibration.json"), json);
  write_png(out.file("coverage.png"), draw_coverage(lens).view());
  write_png(out.file("residuals.png"), draw_residuals(lens).view());
  write_file(out.file("camera.txt"), calibrated_camera_text(lens, kWorkingSide));
}

void run_calibrate(const LensArguments& a) {
  if (a.sequence.empty() || a.board.empty() || a.out.empty())
    throw Error("ldso calibrate", "images or a video, --board and -o are needed", "see `ldso calibrate --help`");
  if (camera_of(a.sequence.string()))
    throw Error(a.sequence.string(), "is a camera", "record some 30 seconds of the board and give the file");
  const Board board = parse_board(a.board, "--board");
  OutputFolder out = open_calibration_folder(a);
  DatasetOptions options = a.dataset;
  options.uncalibrated = true;
  const auto dataset = open_dataset(a.sequence, options);
  const std::string name = a.sequence.lexically_normal().string();
  ViewSearch found;
  {
    ProgressBar bar(a.json, 1000000);
    found = find_views(*dataset, board, a.views, name,
                       [&](int done, int count) { bar.update(done, count, "looking for the board"); });
  }
  std::vector<LensCalibration> others;
  const LensCalibration lens = calibrate(a, found, board, others);
  const std::vector<std::string> advice = calibration_advice(lens);
  const std::string json = json_text(calibration_json(lens, board, others, advice), 2) + "\n";
  write_results(out, lens, json);
  if (a.json) {
    std::cout << json;
    return;
  }
  std::cout << found.looked_at << " frames looked at, " << found.seen << " show the board, " << found.views.size()
            << " used\n"
            << calibration_text(lens, others, advice) << (a.out / "camera.txt").string() << "\n";
}

void write_sheet(const SheetArguments& a) {
  Board board = parse_board(a.board, "board");
  const Paper paper = parse_paper(a.paper, "--paper");
  const bool has_size = std::count(a.board.begin(), a.board.end(), ':') > 1;
  if (!has_size) board = fitted_to(board, paper);
  std::string ending = a.out.extension().string();
  if (ending != ".pdf" && ending != ".svg")
    throw Error(a.out.string(), "is neither a .pdf nor a .svg", "let the name of -o end in one of them");
  const std::string sheet = ending == ".pdf" ? board_pdf(board, paper) : board_svg(board, paper);
  refuse_other_file(a.out, {"%PDF-1.4", "<svg"}, "a board");
  write_file(a.out, sheet);
  std::cout << a.out.string()
            << ": print it at 100 % (the line below the board is 100 mm long), glue it onto something "
            << "flat, and calibrate with\n  --board " << board_text(board) << "\n";
}

void add_board_command(CLI::App& calibrate) {
  const auto a = std::make_shared<SheetArguments>();
  CLI::App* command = calibrate.add_subcommand("board", "Write a board to print, as PDF or SVG");
  command
      ->add_option("board", a->board,
                   "Kind, number and size: " + std::string(kBoardForms) + ". Without sizes it fills the paper")
      ->required();
  command->add_option("-o,--out", a->out, "File to write, .pdf or .svg")->required();
  command->add_option("--paper", a->paper, "a4, a3, a2, a1, a0, letter, tabloid or WIDTHxHEIGHT in millimetres")
      ->capture_default_str();
  command->callback([a] { write_sheet(*a); });
}

void add_lens_options(CLI::App& command, LensArguments& a) {
  command.add_option("sequence", a.sequence,
                     "Folder of images or video file of the board (./board for a folder of that name)");
  command.add_option("--board", a.board, "What is seen: " + std::string(kBoardForms));
  command.add_option("-o,--out", a.out, "Folder for camera.txt, calibration.json, coverage.png and residuals.png");
  command
      .add_option("--model", a.model,
                  "Lens model: pinhole, fov, radtan (OpenCV's with k1 k2 p1 p2), radtan-k3, kannala-brandt (fisheyes); "
                  "auto: the one that explains the points best with as few parameters as it takes")
      ->check(CLI::IsMember(model_names()))
      ->capture_default_str();
  command.add_option("--views", a.views, "At most so many views are used: those that tell most")
      ->check(CLI::Range(3, 1000))
      ->capture_default_str();
  command.add_option("--start", a.dataset.start, "First frame")->check(number_from_zero());
  command.add_option("--end", a.dataset.end,
                     "First frame that is not used any more; negative: so many left out at the end");
  command.add_option("--stride", a.dataset.stride, "Use every n-th frame")->check(positive_number());
  command.add_option("--pattern", a.dataset.pattern,
                     "Which images of a folder, e.g. left%d.jpg (%d: a number, *: any text)");
  command.add_flag("--json", a.json, "Print the content of calibration.json instead of text");
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  const auto a = std::make_shared<LensArguments>();
  CLI::App* command = app.add_subcommand("calibrate", "Measure the camera: camera.txt from images of a board");
  add_lens_options(*command, *a);
  add_board_command(*command);
  add_photometric_command(*command);
  command->require_subcommand(0, 1);
  command->callback([a, command] {
    if (command->get_subcommands().empty()) run_calibrate(*a);
  });
}

}  // namespace ldso
