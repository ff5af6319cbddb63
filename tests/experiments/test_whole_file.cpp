#include <boost/test/unit_test.hpp>

#include "experiments/whole_file.hpp"
#include "src/scene/invalid_input.hpp"
#include "tests/experiments/process.hpp"

using namespace qddot;

namespace {

std::string refusal(const std::string& path) {
  try {
    WholeFile file(path);
    return "";
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(whole_file)

BOOST_AUTO_TEST_CASE(nothing_stands_at_its_place_before_the_commit) {
  const Folder folder;
  WholeFile file(folder / "a.txt");
  file.write("half");
  BOOST_TEST(!std::filesystem::exists(folder / "a.txt"));
  file.write(" and half");
  file.commit();
  BOOST_TEST(folder.listing() == "a.txt ");
  BOOST_TEST(read_all(folder / "a.txt") == "half and half");
}

BOOST_AUTO_TEST_CASE(nothing_is_left_where_it_is_not_committed) {
  const Folder folder;
  { WholeFile(folder / "a.txt").write("half"); }
  BOOST_TEST(folder.listing() == "");
}

BOOST_AUTO_TEST_CASE(an_older_file_stays_until_the_commit_and_goes_with_it) {
  const Folder folder;
  folder.write("a.txt", "old");
  { WholeFile(folder / "a.txt").write("lost"); }
  BOOST_TEST(read_all(folder / "a.txt") == "old");
  WholeFile file(folder / "a.txt");
  file.write("new");
  BOOST_TEST(read_all(folder / "a.txt") == "old");
  file.commit();
  BOOST_TEST(read_all(folder / "a.txt") == "new");
  BOOST_TEST(folder.listing() == "a.txt ");
}

BOOST_AUTO_TEST_CASE(places_that_cannot_be_written_are_refused) {
  const Folder folder;
  folder.write("file", "");
  BOOST_TEST(contains(refusal(folder.path()), {folder.path(), "folder", "allowed"}));
  for (const std::string& path :
       {folder / "none/a.txt", folder / "file/a.txt", std::string("/proc/a.txt")}) {
    BOOST_TEST(contains(refusal(path), {path, "cannot be written", "allowed"}), path);
  }
  if (geteuid() != 0) {  // who may write anywhere
    std::filesystem::permissions(
        folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    BOOST_TEST(contains(refusal(folder / "a.txt"), {"cannot be written", "allowed"}));
    std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  }
  BOOST_TEST(folder.listing() == "file ");
}

BOOST_AUTO_TEST_CASE(a_commit_that_fails_throws_and_leaves_nothing_beside) {
  const Folder folder;
  WholeFile file(folder / "a.txt");
  file.write("x");
  std::filesystem::create_directories(folder / "a.txt/b");
  BOOST_CHECK_THROW(file.commit(), std::runtime_error);
  BOOST_TEST(folder.listing() == "a.txt ");
}

BOOST_AUTO_TEST_CASE(negative_control_a_listing_shows_what_is_left) {
  const Folder folder;
  WholeFile file(folder / "a.txt");
  BOOST_TEST(folder.listing() != "");
  BOOST_TEST(refusal(folder / "b.txt") == "");
}

BOOST_AUTO_TEST_SUITE_END()
