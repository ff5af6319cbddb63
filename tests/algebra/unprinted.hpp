#pragma once

#include <boost/test/unit_test.hpp>

#include "qddot/algebra/effective_mass.hpp"

// What has no text of its own; once for all tests, which Boost.Test asks for.
BOOST_TEST_DONT_PRINT_LOG_VALUE(qddot::Definiteness)
BOOST_TEST_DONT_PRINT_LOG_VALUE(qddot::SolveOutcome)
