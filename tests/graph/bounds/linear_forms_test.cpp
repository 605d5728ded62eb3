// Bases of linear forms, against direct evaluation at random points.
#include "graph/bounds/linear_forms.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace fw::linear_forms_test {

constexpr std::array<IrId, 3> kAtoms{0, 1, 2};

double valueOf(const LinearForm& form, std::span<const double> atoms) {
    double value = form.constant;
    for (const LinearForm::Term& term : form.terms) value += term.factor * atoms[term.atom];
    return value;
}

LinearForm formOf(std::array<double, 3> factors, double constant) {
    LinearForm form{.terms = {}, .constant = constant};
    for (IrId i = 0; i < 3; ++i)
        if (factors[i] != 0.0) form.terms.push_back({i, factors[i]});
    return form;
}

TEST(LinearBasis, HoldsAllForms) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int n = 0; n < 500; ++n) {
        std::vector<LinearForm> forms;
        const int dimensions = 1 + n % 3;
        std::array<std::array<double, 3>, 3> directions;
        for (auto& direction : directions) direction = {unit(random), unit(random), unit(random)};
        for (int i = 0; i < 6; ++i) {
            std::array<double, 3> factors{};
            const double size = std::pow(10.0, 2.0 * unit(random));
            for (int d = 0; d < dimensions; ++d) {
                const double share = d == i % dimensions ? size : 0.5 * size * unit(random);
                for (std::size_t k = 0; k < 3; ++k) factors[k] += share * directions[std::size_t(d)][k];
            }
            forms.push_back(formOf(factors, unit(random)));
        }
        const LinearBasis basis = basisOf(forms, kAtoms);
        if (basis.chosen.empty()) continue;  // nearly parallel
        ASSERT_EQ(basis.forms.size(), forms.size());
        EXPECT_LE(basis.chosen.size(), std::size_t(dimensions));
        for (int sample = 0; sample < 10; ++sample) {
            const std::array<double, 3> atoms{10.0 * unit(random), 10.0 * unit(random), 10.0 * unit(random)};
            std::array<double, 3> values{};
            for (std::size_t i = 0; i < basis.chosen.size(); ++i)
                values[i] = valueOf(forms[basis.chosen[i]], atoms);
            for (std::size_t i = 0; i < forms.size(); ++i) {
                const double wanted = valueOf(forms[i], atoms);
                EXPECT_NEAR(valueOf(basis.forms[i], values), wanted, 1e-9 * (1.0 + std::abs(wanted)));
            }
        }
    }
}

TEST(LinearBasis, IgnoresRoundingErrorsAsDirections) {
    const std::vector<LinearForm> forms{formOf({4e-17, -1e-16, 0.0}, 7e-16), formOf({0.6, 0.8, 0.0}, 1.0),
                                        formOf({0.8, -0.6, 0.0}, 2.0)};
    const LinearBasis basis = basisOf(forms, kAtoms);
    EXPECT_EQ(basis.chosen, (std::vector<std::size_t>{1, 2}));
}

TEST(LinearBasis, OfMoreThanThreeAtomsIsEmpty) {
    const std::array<IrId, 4> atoms{0, 1, 2, 3};
    const std::vector<LinearForm> forms{formOf({1.0, 2.0, 3.0}, 0.0)};
    EXPECT_TRUE(basisOf(forms, atoms).chosen.empty());
}

TEST(SolveForUnbounded, JoinsHalfSpacesToSlabs) {
    // -1 <= x + 2 y <= 3 as two half-spaces, one of them scaled; 0 <= x - y <= 1 as a slab.
    const std::vector<LinearForm> forms{formOf({1.0, 2.0, 0.0}, 5.0), formOf({-0.5, -1.0, 0.0}, 0.0),
                                        formOf({1.0, -1.0, 0.0}, 0.0)};
    const std::vector<Interval> bounds{{-kHuge, 8.0}, {-kHuge, 0.5}, {0.0, 1.0}};
    std::array<Interval, 3> atoms{kEverything, kEverything, kEverything};
    EXPECT_EQ(solveForUnbounded(forms, bounds, atoms).size(), 2u);
    EXPECT_NEAR(atoms[0].lo, -1.0 / 3.0, 1e-6);
    EXPECT_NEAR(atoms[0].hi, 5.0 / 3.0, 1e-6);
    EXPECT_NEAR(atoms[1].lo, -2.0 / 3.0, 1e-6);
    EXPECT_NEAR(atoms[1].hi, 1.0, 1e-6);
    EXPECT_FALSE(isBounded(atoms[2]));
}

TEST(SolveForUnbounded, NeedsBothSides) {
    const std::vector<LinearForm> forms{formOf({1.0, 2.0, 0.0}, 0.0), formOf({1.0, -1.0, 0.0}, 0.0)};
    const std::vector<Interval> bounds{{-kHuge, 8.0}, {0.0, 1.0}};
    std::array<Interval, 3> atoms{kEverything, kEverything, kEverything};
    EXPECT_TRUE(solveForUnbounded(forms, bounds, atoms).empty());
}

TEST(LinearForm, RangesHoldTheValues) {
    const LinearForm form = formOf({2.0, -3.0, 0.5}, 1.0);
    const std::array<Interval, 3> atoms{Interval{-1.0, 2.0}, {0.0, 4.0}, {-kHuge, 8.0}};
    const Interval range = rangeOver(form, atoms);
    EXPECT_EQ(range.lo, -kHuge);
    EXPECT_NEAR(range.hi, 9.0, 1e-9);
    EXPECT_GE(range.hi, 9.0);
    // 2 x = range - 1 + 3 y - z / 2
    const Interval x = solveForTerm(form, 0, {0.0, 1.0}, atoms);
    EXPECT_NEAR(x.lo, 0.5 * (0.0 - 1.0 + 0.0 - 4.0), 1e-9);
    EXPECT_EQ(x.hi, kHuge);
}

}  // namespace fw::linear_forms_test
