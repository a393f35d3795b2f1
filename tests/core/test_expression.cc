#include <firn/core/error.h>
#include <firn/core/expression.h>
#include <firn/core/parallel.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace firn {
namespace {

double value_of(const std::string& text) { return Expression(text)(Vec3d{{1.5, -2, 3}}, 0.25); }

std::string error_of(const std::string& text) {
  try {
    value_of(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "";
}

TEST(Expression, KnowsPlaceTimeAndPi) {
  EXPECT_EQ(value_of("x + 10 * y + 100 * z + 1000 * t"), 1.5 - 20 + 300 + 250);
  EXPECT_EQ(value_of("pi"), M_PI);
  EXPECT_EQ(value_of("1e-3"), 1e-3);
}

TEST(Expression, FollowsTheRulesOfAlgebra) {
  EXPECT_EQ(value_of("2 + 3 * 4 - 6 / 3"), 12);
  EXPECT_EQ(value_of("-x^2"), -2.25);
  EXPECT_EQ(value_of("2^3^2"), 512);
  EXPECT_EQ(value_of("(2 + 3) * 4"), 20);
  EXPECT_EQ(value_of("x > 1 && y < 0 ? 7 : 8"), 7);
  EXPECT_EQ(value_of("x > 2 || y == 0 ? 7 : x != 1 ? 9 : 10"), 9);
}

TEST(Expression, FunctionsAreThoseOfTheLibrary) {
  EXPECT_EQ(value_of("sin(x)"), std::sin(1.5));
  EXPECT_EQ(value_of("cos(x) * tan(x)"), std::cos(1.5) * std::tan(1.5));
  EXPECT_EQ(value_of("exp(y)"), std::exp(-2.0));
  EXPECT_EQ(value_of("log(z)"), std::log(3.0));
  EXPECT_EQ(value_of("ln(z)"), std::log(3.0));
  EXPECT_EQ(value_of("log10(1000)"), 3);
  EXPECT_EQ(value_of("sqrt(z)"), std::sqrt(3.0));
  EXPECT_EQ(value_of("abs(y)"), 2);
  EXPECT_EQ(value_of("floor(x) + 10 * ceil(x)"), 21);
  EXPECT_EQ(value_of("min(x, y, z) + 10 * max(x, y, z)"), 28);
  EXPECT_EQ(value_of("atan2(y, x)"), std::atan2(-2.0, 1.5));
  EXPECT_EQ(value_of("sign(y)"), -1);
}

TEST(Expression, ErrorsNameTheTextThePlaceAndWhatWasExpected) {
  EXPECT_EQ(error_of("1 +"), "formula \"1 +\": character 4: ends too early; expected a number, a name or (");
  EXPECT_EQ(error_of("1 + * 2"),
            "formula \"1 + * 2\": character 5: unexpected operator \"*\"; expected a number, a name or (");
  EXPECT_EQ(error_of("2 x"),
            "formula \"2 x\": character 3: unexpected \"x\"; expected an operator such as + or * before it");
  EXPECT_EQ(error_of("sin(x"), "formula \"sin(x\": character 6: a ) is missing");
  EXPECT_EQ(error_of("x)"), "formula \"x)\": character 2: unexpected \")\"");
  EXPECT_EQ(error_of("sin + 1"), "formula \"sin + 1\": character 1: the function \"sin\" needs a ( after it");
  EXPECT_EQ(error_of("atan2(x)"), "formula \"atan2(x)\": character 8: too few values for the function \"atan2\"");
  EXPECT_EQ(error_of("sin(x, y)"), "formula \"sin(x, y)\": character 9: too many values for the function \"sin\"");
  EXPECT_EQ(error_of("x > 1 ? 2"),
            "formula \"x > 1 ? 2\": character 10: a ? needs a : with the value for the other case");
  EXPECT_EQ(error_of(""), "formula \"\": is empty; expected a number or a formula such as 2 * x");
  EXPECT_EQ(error_of("1,5"),
            "formula \"1,5\": has 2 values with commas between them; expected one, with a point in it: 1.5");
  EXPECT_EQ(error_of("x = 3"), "formula \"x = 3\": character 3: unexpected =; a comparison is written ==");
  EXPECT_EQ(error_of("'a'"), "formula \"'a'\": character 1: a formula has no text in it");
  EXPECT_EQ(error_of("2 \xc3\x97 x"),
            "formula \"2 \xc3\x97 x\": character 3: expected letters without accents, digits, signs");
  EXPECT_EQ(error_of("x\n"), "formula \"x?\": character 2: expected letters without accents, digits, signs");
  EXPECT_NE(error_of(std::string(1001, '1')).find("has 1001 characters; at most 1000 are allowed"), std::string::npos);
}

TEST(Expression, AnUnknownNameListsTheKnownOnes) {
  const std::string error = error_of("2 * u");
  EXPECT_EQ(error.find("formula \"2 * u\": character 5: unknown name \"u\"; known are x, y, z, t, pi and the functions "
                       "abs, acos, "),
            0u)
      << error;
  constexpr std::string_view kOnlyTime[] = {"t"};
  try {
    Expression("x", kOnlyTime);
    FAIL();
  } catch (const Error& wrong) {
    EXPECT_NE(std::string(wrong.what()).find("unknown name \"x\"; known are t, pi and"), std::string::npos);
  }
}

TEST(Expression, AValueThatIsNotFiniteIsAnErrorWithThePlace) {
  EXPECT_EQ(error_of("1 / (x - 1.5)"),
            "formula \"1 / (x - 1.5)\": is infinite at x = 1.5, y = -2, z = 3, t = 0.25; it must be a finite number "
            "there");
  EXPECT_EQ(
      error_of("sqrt(y)"),
      "formula \"sqrt(y)\": is not a number at x = 1.5, y = -2, z = 3, t = 0.25; it must be a finite number there");
}

TEST(Expression, CopiesAndThreadsGiveTheSameBits) {
  const Expression formula("exp(sin(x)) * y + floor(10 * t) ^ 0.3");
  const Expression copy = formula;
  constexpr std::size_t kCount = 20000;
  const auto place = [](std::size_t i) {
    return Vec3d{{0.001 * static_cast<double>(i), 2.0 - static_cast<double>(i), 0}};
  };
  std::vector<double> alone(kCount), together(kCount);
  for (std::size_t i = 0; i < kCount; ++i) alone[i] = copy(place(i), 0.001 * static_cast<double>(i));
  parallel_each(kCount, [&](std::size_t i) { together[i] = formula(place(i), 0.001 * static_cast<double>(i)); });
  EXPECT_EQ(std::memcmp(alone.data(), together.data(), kCount * sizeof(double)), 0);
}

TEST(Expression, AnyTextIsAFormulaOrAnError) {
  const std::string_view pieces[] = {"x", "y", "1",  ".5", "1e3", "+",   "-",    "*",  "/", "^", "(", ")", ",",     "?",
                                     ":", "<", "==", "&&", "||",  "sin", "min(", "pi", " ", "!", ";", "_", "atan2("};
  std::uint64_t state = 1;
  int formulas = 0, errors = 0;
  for (int n = 0; n < 5000; ++n) {
    std::string text;
    for (int k = 0; k < 1 + n % 12; ++k) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      text += pieces[(state >> 33) % std::size(pieces)];
    }
    try {
      value_of(text);
      ++formulas;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++errors;
    }
  }
  EXPECT_GT(formulas, 50);
  EXPECT_GT(errors, 1000);
}

}  // namespace
}  // namespace firn
