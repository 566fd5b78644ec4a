#pragma once
// The subcommands, one a file (`ldso experiment`: experiment/). They run while the command line is parsed, and throw
// ldso::Error on bad input. Those that may end otherwise than well or with an error set `exit_code`, which must outlive
// the parsing.

#include <CLI/CLI.hpp>

namespace ldso {

/// Exit code of `ldso run` if nothing was tracked in the whole sequence; results are written all the same.
inline constexpr int kNothingTrackedExitCode = 2;
/// Not all results could be written: the disk is full, for instance.
inline constexpr int kIncompleteExitCode = 3;

/// `ldso run SEQUENCE -o OUT`: images to a trajectory and a map. Ends with kNothingTrackedExitCode or, by Ctrl-C, with
/// kInterruptedExitCode.
void add_run_command(CLI::App& app, int& exit_code);
/// `ldso doctor SEQUENCE`: what is wrong with a sequence, and what to do. Ends with 2 if results will suffer from it, 1
/// if it cannot be run.
void add_doctor_command(CLI::App& app, int& exit_code);
/// `ldso calibrate SEQUENCE --board BOARD -o OUT`: camera.txt from images of a board; `ldso calibrate board`: the
/// board.
void add_calibrate_command(CLI::App& app);
/// `ldso resume OUT`: results of a run that was cut off, from its last checkpoint.
void add_resume_command(CLI::App& app);
/// `ldso view OUT`: a finished run in the browser.
void add_view_command(CLI::App& app);
/// `ldso export OUT`: the map and the trajectory of a finished run in the formats of other programs.
void add_export_command(CLI::App& app);
/// `ldso eval ESTIMATE GROUNDTRUTH`: how accurate is a trajectory?
void add_eval_command(CLI::App& app);
/// `ldso vocab`: trains, converts and describes vocabularies for place recognition.
void add_vocab_command(CLI::App& app);
/// `ldso settings`: all settings with defaults, ranges and what they are.
void add_settings_command(CLI::App& app);
/// `ldso bench`: how many frames a second this machine does, in one line.
void add_bench_command(CLI::App& app);
/// `ldso simulate WORLD -o DIR`: renders a sequence with exact ground truth.
void add_simulate_command(CLI::App& app);

}  // namespace ldso
