#define BOOST_TEST_MODULE qddot
#include <boost/test/unit_test.hpp>
