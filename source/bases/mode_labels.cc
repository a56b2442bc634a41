// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/bases/mode_labels.h>

#include <map>

namespace Squeal
{
  namespace
  {
    std::string text_of(const ModeLabel &label, const std::string &blank, const char *minus, const char *plus)
    {
      std::string text = to_string(label.family);
      if (label.rank > 0)
        text += label.body + blank + std::to_string(label.rank);
      else if (label.family != ModeFamily::unnamed && label.family != ModeFamily::rigid_body)
        text += std::to_string(label.nodal_circles) + "-" + std::to_string(label.nodal_diameters);
      return text + (label.sign == DoubletSign::none ? "" : label.sign == DoubletSign::minus ? minus : plus);
    }
  } // namespace

  bool operator==(const ModeLabel &a, const ModeLabel &b)
  {
    return a.shape() == b.shape() && a.sign == b.sign;
  }

  std::string to_string(const ModeLabel &label)
  {
    return text_of(label, label.body.empty() ? "" : " ", " -", " +");
  }

  std::string file_text(const ModeLabel &label)
  {
    return text_of(label, label.body.empty() ? "" : "_", "_minus", "_plus");
  }

  std::string shape_text(ModeLabel label)
  {
    label.sign = DoubletSign::none;
    return to_string(label);
  }

  void mark_doublets(std::vector<ModeLabel> &labels, const std::vector<double> &growth_rates)
  {
    std::map<ModeShape, std::vector<std::size_t>> places;
    for (std::size_t i = 0; i < labels.size(); ++i)
      if (labels[i].family != ModeFamily::unnamed)
        places[labels[i].shape()].push_back(i);
    for (const auto &[shape, modes] : places)
      if (modes.size() == 2)
        {
          const bool first_grows_more           = !growth_rates.empty() && growth_rates[modes[0]] > growth_rates[modes[1]];
          labels[modes[!first_grows_more]].sign = DoubletSign::plus;
          labels[modes[first_grows_more]].sign  = DoubletSign::minus;
        }
  }
} // namespace Squeal
