#pragma once

#include <boost/test/unit_test.hpp>

#include "qddot/algebra/effective_mass.hpp"

// Types without text, declared once for all tests as Boost.Test requires.
BOOST_TEST_DONT_PRINT_LOG_VALUE(qddot::Definiteness)
BOOST_TEST_DONT_PRINT_LOG_VALUE(qddot::SolveOutcome)
