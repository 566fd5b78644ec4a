// One set of properties for all groups and both scalar types.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <numbers>
#include <random>
#include <type_traits>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "ldso/error.h"
#include "ldso/se3.h"
#include "ldso/sim3.h"
#include "ldso/so3.h"

namespace ldso {
namespace {

template <class Group>
struct Traits;
template <template <class> class GroupTemplate, class S>
struct Traits<GroupTemplate<S>> {
  using Scalar = S;
  using Double = GroupTemplate<double>;
  using Other = GroupTemplate<std::conditional_t<std::is_same_v<S, float>, double, float>>;
};

template <class Group>
class LieGroupTest : public testing::Test {
 protected:
  using ScalarType = typename Traits<Group>::Scalar;
  using DoubleType = typename Traits<Group>::Double;
  using TangentType = typename Group::Tangent;
  using TangentDType = typename DoubleType::Tangent;
  using JacobianDType = typename DoubleType::Jacobian;
  static constexpr double kEps = std::numeric_limits<ScalarType>::epsilon();
  static constexpr int kOmega = Group::kDof == 3 ? 0 : 3;  // where the rotation vector begins
  static constexpr bool kHasScale = Group::kDof == 7;

  /// Rotation angles from none over those where formulas switch to almost pi.
  static std::vector<double> angles() {
    return {0,   1e-20, 1e-12, 1e-8, 1e-6, 1e-5, 1.2e-4, 3e-4, 1e-3, 0.01, 0.018, 0.02,
            0.1, 0.3,   0.5,   0.9,  1,    1.01, 1.5,    2,    2.5,  3,    3.1,   std::numbers::pi - 1e-3};
  }

  static std::vector<double> log_scales() {
    return kHasScale ? std::vector<double>{0, 1e-12, -1e-6, 1e-3, -0.1, 0.7, -2.5} : std::vector<double>{0};
  }

  static Eigen::Vector3d random_direction(std::mt19937& generator) {
    std::normal_distribution<double> normal;
    Eigen::Vector3d v(normal(generator), normal(generator), normal(generator));
    return v.normalized();
  }

  /// Tangents of every angle and log scale, random otherwise.
  static std::vector<TangentType> tangents() {
    std::mt19937 generator(7);
    std::vector<TangentType> result;
    for (const double angle : angles()) {
      for (const double log_scale : log_scales()) {
        TangentDType x = TangentDType::Zero();
        if constexpr (Group::kDof > 3) x.template head<3>() = 2 * random_direction(generator);
        x.template segment<3>(kOmega) = angle * random_direction(generator);
        if constexpr (kHasScale) x[6] = log_scale;
        result.push_back(x.template cast<ScalarType>());
      }
    }
    return result;
  }

  /// A small set of quite different elements.
  static std::vector<Group> elements() {
    std::vector<Group> result{Group()};
    const std::vector<TangentType> all = tangents();
    for (std::size_t i = 0; i < all.size(); i += 1 + all.size() / 12) result.push_back(Group::exp(all[i]));
    return result;
  }

  static double distance(const Group& a, const Group& b) {
    return (a.matrix() - b.matrix()).template cast<double>().norm();
  }
  static double size(const Group& a) { return 1 + a.matrix().template cast<double>().norm(); }

  static TangentDType unit(int i) { return TangentDType::Unit(i); }
};

using Groups = testing::Types<SO3<double>, SO3<float>, SE3<double>, SE3<float>, Sim3<double>, Sim3<float>>;
TYPED_TEST_SUITE(LieGroupTest, Groups);

TYPED_TEST(LieGroupTest, DefaultIsTheIdentity) {
  const TypeParam identity;
  EXPECT_TRUE(identity.matrix().isIdentity(0));
  EXPECT_TRUE(identity.log().isZero(0));
}

TYPED_TEST(LieGroupTest, ExpIsTheMatrixExponential) {
  using Double = typename TestFixture::DoubleType;
  for (const auto& x : this->tangents()) {
    const Eigen::MatrixXd algebra = Double::hat(x.template cast<double>());
    const Eigen::MatrixXd expected = algebra.exp();
    const TypeParam actual = TypeParam::exp(x);
    EXPECT_LT((actual.matrix().template cast<double>() - expected).norm(), 10 * this->kEps * this->size(actual))
        << x.transpose();
  }
}

TYPED_TEST(LieGroupTest, LogInvertsExp) {
  for (const auto& x : this->tangents()) {
    const auto y = TypeParam::exp(x).log();
    EXPECT_LT((y - x).template cast<double>().norm(), 60 * this->kEps * (1 + x.template cast<double>().norm()))
        << x.transpose() << "\n"
        << y.transpose();
  }
}

TYPED_TEST(LieGroupTest, SmallRotationsKeepTheirRelativePrecision) {
  using Tangent = typename TestFixture::TangentType;
  for (const double angle : {1e-18, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2}) {
    Tangent x = Tangent::Zero();
    x[this->kOmega + 1] = static_cast<typename TestFixture::ScalarType>(angle);
    const Tangent y = TypeParam::exp(x).log();
    EXPECT_LT((y - x).norm(), 4 * this->kEps * angle) << angle;
  }
}

TYPED_TEST(LieGroupTest, ExpInvertsLogAtAndBeyondPi) {
  using Scalar = typename TestFixture::ScalarType;
  using Tangent = typename TestFixture::TangentType;
  std::mt19937 generator(3);
  const double pi = std::numbers::pi;
  for (const double angle : {pi - 1e-5, pi - 1e-9, pi, pi + 1e-9, pi + 1e-4, 4.0, 6.0}) {
    Tangent x = Tangent::Constant(Scalar(0.3));
    x.template segment<3>(this->kOmega) = (angle * this->random_direction(generator)).template cast<Scalar>();
    const TypeParam element = TypeParam::exp(x);
    const Tangent y = element.log();
    EXPECT_LE(y.template segment<3>(this->kOmega).norm(), Scalar(pi) * (1 + 4 * this->kEps));
    EXPECT_LT(this->distance(TypeParam::exp(y), element), 30 * this->kEps * this->size(element)) << angle;
  }
}

TYPED_TEST(LieGroupTest, InverseAndAssociativity) {
  const auto elements = this->elements();
  for (const auto& a : elements) {
    const double condition = this->size(a) * this->size(a.inverse());
    EXPECT_LT(this->distance(a * a.inverse(), TypeParam()), 4 * this->kEps * condition);
    for (const auto& b : elements) {
      for (const auto& c : elements) {
        const double bound = 8 * this->kEps * this->size(a) * this->size(b) * this->size(c);
        EXPECT_LT(this->distance((a * b) * c, a * (b * c)), bound);
      }
    }
  }
}

TYPED_TEST(LieGroupTest, ProductsAndActionAgreeWithMatrices) {
  using Scalar = typename TestFixture::ScalarType;
  const Eigen::Matrix<Scalar, 3, 1> p(Scalar(0.3), Scalar(-2), Scalar(5));
  const auto elements = this->elements();
  for (const auto& a : elements) {
    Eigen::Matrix<Scalar, 3, 1> expected = a.matrix().template topLeftCorner<3, 3>() * p;
    if constexpr (TypeParam::kDof > 3) expected += a.matrix().template topRightCorner<3, 1>();
    EXPECT_LT((a * p - expected).norm(), 30 * this->kEps * this->size(a));
    for (const auto& b : elements) {
      const double bound = 8 * this->kEps * this->size(a) * this->size(b);
      EXPECT_LT(((a * b).matrix() - a.matrix() * b.matrix()).norm(), bound);
      TypeParam in_place = a;
      in_place *= b;
      EXPECT_EQ(this->distance(in_place, a * b), 0);
    }
  }
}

TYPED_TEST(LieGroupTest, AdjointIsTheDerivativeOfConjugation) {
  using Double = typename TestFixture::DoubleType;
  using JacobianD = typename TestFixture::JacobianDType;
  const double step = 1e-6;
  for (const auto& element : this->elements()) {
    const Double g = element.template cast<double>();
    JacobianD numeric;
    for (int i = 0; i < Double::kDof; ++i) {
      const auto forward = (g * Double::exp(step * this->unit(i)) * g.inverse()).log();
      const auto backward = (g * Double::exp(-step * this->unit(i)) * g.inverse()).log();
      numeric.col(i) = (forward - backward) / (2 * step);
    }
    const JacobianD analytic = element.adjoint().template cast<double>();
    EXPECT_LT((analytic - numeric).norm(), (1e-8 + 10 * this->kEps) * numeric.norm());
  }
}

TYPED_TEST(LieGroupTest, SmallAdjointIsTheDerivativeOfTheAdjoint) {
  using Double = typename TestFixture::DoubleType;
  const double step = 1e-6;
  for (int i = 0; i < Double::kDof; ++i) {
    const auto x = this->unit(i);
    const typename TestFixture::JacobianDType numeric =
        (Double::exp(step * x).adjoint() - Double::exp(-step * x).adjoint()) / (2 * step);
    const auto analytic = TypeParam::small_adjoint(x.template cast<typename TestFixture::ScalarType>());
    EXPECT_LT((analytic.template cast<double>() - numeric).norm(), 1e-9);
  }
}

TYPED_TEST(LieGroupTest, LeftJacobianIsTheDerivativeOfExp) {
  using Double = typename TestFixture::DoubleType;
  using JacobianD = typename TestFixture::JacobianDType;
  const double step = 1e-5;
  for (const auto& tangent : this->tangents()) {
    const typename TestFixture::TangentDType x = tangent.template cast<double>();
    const Double inverse = Double::exp(x).inverse();
    JacobianD numeric;
    for (int i = 0; i < Double::kDof; ++i) {
      const auto forward = (Double::exp(x + step * this->unit(i)) * inverse).log();
      const auto backward = (Double::exp(x - step * this->unit(i)) * inverse).log();
      numeric.col(i) = (forward - backward) / (2 * step);
    }
    const JacobianD analytic = TypeParam::left_jacobian(tangent).template cast<double>();
    EXPECT_LT((analytic - numeric).norm(), (1e-8 + 20 * this->kEps) * numeric.norm()) << x.transpose();
  }
}

TYPED_TEST(LieGroupTest, LeftJacobianInverseIsItsInverse) {
  using JacobianD = typename TestFixture::JacobianDType;
  for (const auto& x : this->tangents()) {
    const JacobianD J = TypeParam::left_jacobian(x).template cast<double>();
    const JacobianD J_inverse = TypeParam::left_jacobian_inverse(x).template cast<double>();
    const double bound = 20 * this->kEps * J.norm() * J_inverse.norm();
    EXPECT_LT((J * J_inverse - JacobianD::Identity()).norm(), bound) << x.transpose();
  }
}

TYPED_TEST(LieGroupTest, CastGoesThereAndBack) {
  using Other = typename Traits<TypeParam>::Other;
  using OtherScalar = typename Traits<Other>::Scalar;
  for (const auto& a : this->elements()) {
    const Other other = a.template cast<OtherScalar>();
    const TypeParam back = other.template cast<typename TestFixture::ScalarType>();
    EXPECT_LT(this->distance(a, back), 4 * std::numeric_limits<float>::epsilon() * this->size(a));
  }
}

TYPED_TEST(LieGroupTest, MatrixGoesThereAndBack) {
  for (const auto& a : this->elements()) {
    EXPECT_LT(this->distance(TypeParam::from_matrix(a.matrix()), a), 10 * this->kEps * this->size(a));
  }
}

TYPED_TEST(LieGroupTest, BadMatricesAreErrors) {
  auto matrix = TypeParam().matrix();
  matrix(0, 0) = -1;
  EXPECT_THROW(TypeParam::from_matrix(matrix), Error);
  matrix(0, 0) = std::numeric_limits<typename TestFixture::ScalarType>::quiet_NaN();
  EXPECT_THROW(TypeParam::from_matrix(matrix), Error);
  matrix.setZero();
  EXPECT_THROW(TypeParam::from_matrix(matrix), Error);
}

TYPED_TEST(LieGroupTest, LongProductsStayRotations) {
  using Tangent = typename TestFixture::TangentType;
  using Scalar = typename TestFixture::ScalarType;
  Tangent x = Tangent::Zero();
  x.template segment<3>(this->kOmega) << Scalar(0.1), Scalar(-0.2), Scalar(0.3);
  const TypeParam step = TypeParam::exp(x);
  TypeParam product;
  for (int i = 0; i < 100000; ++i) product *= step;
  const Eigen::Matrix<Scalar, 3, 3> R = product.matrix().template topLeftCorner<3, 3>();
  EXPECT_LT((R * R.transpose() - Eigen::Matrix<Scalar, 3, 3>::Identity()).norm(), 10 * this->kEps);
}

TEST(SO3Test, FromMatrixFindsTheNearestRotation) {
  const SO3d R = SO3d::exp(Eigen::Vector3d(0.3, -1.2, 0.8));
  // A symmetric positive stretch does not change the nearest rotation.
  Eigen::Matrix3d stretch;
  stretch << 1.1, 0.05, 0, 0.05, 0.9, -0.02, 0, -0.02, 1.2;
  EXPECT_LT((SO3d::from_matrix(R.matrix() * stretch).matrix() - R.matrix()).norm(), 1e-14);
}

TEST(SO3Test, QuaternionsAreNormalizedAndSignFree) {
  const Eigen::Quaterniond q(-0.2, 0.4, 1.0, -0.6);
  const SO3d a(q);
  const SO3d b(Eigen::Quaterniond(-q.coeffs()));
  EXPECT_NEAR(a.quaternion().norm(), 1, 1e-15);
  EXPECT_LT((a.log() - b.log()).norm(), 1e-14);
  EXPECT_LE(a.log().norm(), std::numbers::pi);
}

TEST(Sim3Test, RigidMotionAndScale) {
  const SE3d T(SO3d::exp(Eigen::Vector3d(0.1, 0.2, 0.3)), Eigen::Vector3d(1, 2, 3));
  const Sim3d S(T, 2.5);
  const Eigen::Vector3d p(-1, 0.5, 4);
  EXPECT_LT((S * p - (2.5 * (T.rotation() * p) + T.translation())).norm(), 1e-14);
  EXPECT_NEAR(Sim3d::from_matrix(S.matrix()).scale(), 2.5, 1e-14);
}

}  // namespace
}  // namespace ldso
