// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// All of trussmap. Exploration code needs less: map_builder.hpp, or build_map.hpp.
//
// Each header's first line names its component, the target to link. trussmap::map has what
// exploration code needs; trussmap::store, ::trussmap, ::logs, ::datasets and ::distributed include
// it, and the last three trussmap::trussmap, too. Effects in a model take trussmap::trussmap: a
// shape is read from its text. Find the first alone by find_package(trussmap COMPONENTS map).
//
// Threads. Functions share nothing that is changed: they may run in as many threads as there are,
// on the same recordings, models and maps. An object may be read (const calls) by several threads
// as long as none changes it; the classes that ask for more say so.
#pragma once

#include "trussmap/arc.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/check.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/corrected_odometry.hpp"
#include "trussmap/datasets.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/distributed.hpp"
#include "trussmap/error.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/held_out.hpp"
#include "trussmap/landmark_map.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/map_store.hpp"
#include "trussmap/model.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/monitor.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/robot.hpp"
#include "trussmap/running.hpp"
#include "trussmap/session.hpp"
#include "trussmap/shape.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/survey_comparison.hpp"
#include "trussmap/table.hpp"
#include "trussmap/test_path.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/tour_experiment.hpp"
#include "trussmap/truss.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"
#include "trussmap/wording.hpp"
#include "trussmap/workbench.hpp"
#include "trussmap/write_files.hpp"
