#pragma once

// The headers for programs outside the project: scenes, own systems, methods and
// measurements. Everything is in namespace qddot.

#include "qddot/analysis/equilibrium.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/advise.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/exchange/excitation.hpp"
#include "qddot/measure/motion/samples.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/measure/speed/work_precision.hpp"
#include "qddot/measure/stability/diagnosis.hpp"
#include "qddot/measure/stability/linear_limit.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/measure/trend/drift_run.hpp"
#include "qddot/model/differenced_stiffness.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/scene_arrays.hpp"
#include "qddot/scene/scene_file.hpp"
