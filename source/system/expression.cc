// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/system/expression.h>

#include <boost/math/differentiation/finite_difference.hpp>

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <regex>

namespace Squeal
{
  namespace
  {
    /// Number of step sizes, each a tenth of the previous size, and relative difference below which two results agree.
    constexpr int    n_steps              = 10;
    constexpr double largest_disagreement = 1e-6;

    class Expression : public ParameterFunction
    {
    public:
      Expression(const std::string &expression, const std::vector<std::string> &parameters)
        : expression(expression)
      {
        parser.SetExpr(expression);
        for (const std::string &name : parameters)
          parser.DefineVar(name, &variables[name]); // elements of a map have fixed addresses
        int n_results = 0;
        parser.Eval(n_results);
        if (n_results != 1)
          throw ParameterError(Squeal::text(in_quotes(expression), " contains ", n_results, " expressions"), "",
                               "write one expression, with decimal points");
        for (const auto &[name, place] : parser.GetUsedVar())
          used.push_back(name);
      }

      double at(const ParameterValues &values) const override
      {
        // Allow only one evaluation at a time, because all threads share these variables
        const std::lock_guard guard(mutex);
        for (const std::string &name : used)
          variables.at(name) = values.at(name).front();
        return parser.Eval();
      }

      double derivative(const std::string &parameter, const ParameterValues &values) const override
      {
        if (!contains(parameter))
          return 0.;
        ParameterValues others = values;
        double         &value  = others.at(parameter).front();
        const double    x = value, largest = x == 0. ? 1. : std::abs(x);
        // Use the two successive steps that agree best, because the length scale of the expression is unknown
        double best = 0., disagreement = std::numeric_limits<double>::infinity(), before = std::numeric_limits<double>::quiet_NaN();
        for (int k = 0; k < n_steps; ++k)
          {
            const double scale = largest * std::pow(0.1, k);
            const double now   = boost::math::differentiation::finite_difference_derivative(
                                 [&](const double t) {
                                   value = x + scale * t;
                                   return at(others);
                                 },
                                 0.) /
                               scale;
            if (const double difference = std::abs(now - before); difference < disagreement)
              {
                best         = now;
                disagreement = difference;
              }
            before = now;
          }
        if (!(disagreement <= largest_disagreement * std::abs(best)))
          throw ParameterError(Squeal::text("the derivative of ", in_quotes(expression), " with respect to ", parameter, " at ", parameter,
                                            " = ", exact_text(x), " cannot be determined"),
                               "coefficient of a term", "choose another value, or an expression that is smooth there");
        return best;
      }

      bool contains(const std::string &parameter) const override
      {
        return std::find(used.begin(), used.end(), parameter) != used.end();
      }

      bool is_constant() const override
      {
        return used.empty();
      }

      std::string text() const override
      {
        return "(" + expression + ")";
      }

    private:
      const std::string                     expression;
      std::vector<std::string>              used;
      mutable std::map<std::string, double> variables;
      mutable mu::Parser                    parser;
      mutable std::mutex                    mutex;
    };

    /// The expression as a monomial; no value unless it is a product of numbers and integer powers of parameters.
    std::optional<Coefficient> monomial(const std::string &expression, const std::vector<std::string> &parameters)
    {
      static const std::regex factor_pattern(
        R"(\s*([*/]?)\s*(?:(\d{1,15}(?:\.\d{0,30})?(?:[eE][-+]?\d{1,2})?)|([A-Za-z_]\w*)(?:\s*\^\s*(\d{1,3})(?!\d))?)\s*)");
      double                     factor = 1.;
      std::map<std::string, int> powers;
      auto                       at = expression.cbegin();
      for (; at != expression.cend() && (*at == ' ' || *at == '-'); ++at)
        factor *= *at == '-' ? -1. : 1.;
      bool is_first = true;
      for (std::smatch match; at != expression.cend(); at = match.suffix().first, is_first = false)
        {
          if (!std::regex_search(at, expression.cend(), match, factor_pattern, std::regex_constants::match_continuous) ||
              is_first != (match.length(1) == 0))
            return {};
          const bool divides = match.str(1) == "/";
          if (match.length(2) > 0)
            factor *= std::pow(std::stod(match.str(2)), divides ? -1 : 1);
          else if (std::find(parameters.begin(), parameters.end(), match.str(3)) == parameters.end())
            return {};
          else
            powers[match.str(3)] += (divides ? -1 : 1) * (match.length(4) > 0 ? std::stoi(match.str(4)) : 1);
        }
      if (is_first)
        return {};
      for (auto power = powers.begin(); power != powers.end();)
        power = power->second == 0 ? powers.erase(power) : std::next(power);
      return Coefficient(factor, powers);
    }
  } // namespace

  Coefficient parsed_coefficient(const std::string &expression, const std::vector<std::string> &parameters)
  {
    // Reject assignments, which muParser would perform
    static const std::regex assignment(R"((^|[^<>=!])=([^=]|$))");
    if (std::regex_search(expression, assignment))
      throw ParameterError(text("the expression ", in_quotes(expression), " assigns a value"), "",
                           "write == for a comparison, or an expression without an assignment");
    try
      {
        const auto parsed = std::make_shared<Expression>(expression, parameters);
        return monomial(expression, parameters).value_or(Coefficient(parsed));
      }
    catch (const mu::Parser::exception_type &error)
      {
        throw ParameterError(text("the expression ", in_quotes(expression), " cannot be parsed: ", error.GetMsg()), "",
                             "write an expression in the parameters, for example mu*omega^2");
      }
  }

  bool is_parameter_name(const std::string &text)
  {
    static const std::regex name(R"([A-Za-z]\w*)");
    return std::regex_match(text, name);
  }
} // namespace Squeal
