// SPDX-License-Identifier: Apache-2.0
#include "phalanx/core/nearest_name.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx {
namespace {

// kitten, sitten, sittin, sitting; Saturday without a and t, then n for r.
TEST(EditDistance, CountsInsertedDeletedAndReplacedCharacters) {
  struct Case {
    std::string_view a, b;
    std::size_t steps;
  };
  for (const auto& [a, b, steps] :
       {Case{"", "", 0}, Case{"abc", "abc", 0}, Case{"abc", "", 3}, Case{"", "abc", 3}, Case{"a", "ab", 1},
        Case{"ab", "a", 1}, Case{"abc", "abd", 1}, Case{"ab", "ba", 2}, Case{"kitten", "sitting", 3},
        Case{"saturday", "sunday", 3}, Case{"flaw", "lawn", 2}}) {
    EXPECT_EQ(edit_distance(a, b), steps) << a << " " << b;
    EXPECT_EQ(edit_distance(b, a), steps) << b << " " << a;
  }
}

TEST(EditDistance, LooksAtNothingBeforeTheFirstCharacter) {
  const std::string_view text = "xab";
  EXPECT_EQ(edit_distance(text.substr(1), "xab"), 1U);
}

TEST(NameDistance, TakesABeginningOrWhatFollowsTheLastDotForOneStepEach) {
  EXPECT_EQ(name_distance("hooke", "hooke"), 0U);
  EXPECT_EQ(name_distance("hook", "hooke"), 1U);
  EXPECT_EQ(name_distance("torque_rate", "torque_rate_nm_per_s"), 1U);
  EXPECT_EQ(name_distance("torqua_rate", "torque_rate_nm_per_s"), 2U);
  EXPECT_EQ(name_distance("kind", "objects.0.kind"), 1U);
  EXPECT_EQ(name_distance("triang", "objects.0.triangles"), 2U);
  EXPECT_EQ(name_distance("triung", "objects.0.triangles"), 3U);
  EXPECT_EQ(name_distance("objects.0.kind", "objects.0.kind"), 0U);
}

TEST(NearestName, IsTheFirstOfThoseThatAreNearest) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(nearest_name("spere", Names{"box", "sphere", "cylinder"}), "sphere");
  EXPECT_EQ(nearest_name("box", Names{"box", "sphere", "cylinder"}), "box");
  EXPECT_EQ(nearest_name("ab", Names{"ac", "ad"}), "ac");
  EXPECT_EQ(nearest_name("nothing like it", Names{"box"}), "box");
  EXPECT_EQ(nearest_name("ab", Names{}), "");
}

TEST(NearName, IsNoneThatSharesLittleWithWhatWasWritten) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(near_name("spere", Names{"box", "sphere"}), "sphere");
  EXPECT_EQ(near_name("smal-woman", Names{"large-man", "small-woman", "stiff-hand"}), "small-woman");
  EXPECT_EQ(near_name("adult", Names{"large-man", "small-woman", "stiff-hand"}), "");
  EXPECT_EQ(near_name("abcd", Names{"abxy"}), "abxy") << "half of it";
  EXPECT_EQ(near_name("abcd", Names{"axyz"}), "");
  EXPECT_EQ(near_name("abcd", Names{}), "");
  EXPECT_EQ(did_you_mean("spere", Names{"sphere"}), "did you mean \"sphere\"? ");
  EXPECT_EQ(did_you_mean("nothing", Names{"sphere"}), "");
}

TEST(NearestName, ComparesTwoHundredCharacters) {
  const std::string long_name(200, 'a');
  const std::vector<std::string> known = {long_name + 'b', long_name.substr(1), long_name};
  EXPECT_EQ(nearest_name(long_name + 'b', known), long_name);
  EXPECT_EQ(nearest_name(long_name, known), long_name);
}

}  // namespace
}  // namespace phalanx
