#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/materials.h>
#include <squeal/parameters/number_list.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace Squeal
{
  namespace
  {
    const ListFormat mount_list = {"Mounts/Elastic mounts",
                                   "not an elastic mount",
                                   "surface: radial, tangential, axial; surface: ... [N/m^3]",
                                   "surface",
                                   {3}};

    const ListFormat dashpot_list = {"Mounts/Dashpots",
                                     "not a list of dashpots",
                                     "surface: radial, tangential, axial; surface: ... [N s/m^3]",
                                     "surface",
                                     {3}};

    const ListFormat mass_list = {"Mounts/Added masses", "not a mass on a surface", "surface: mass; surface: ... [kg/m^2]", "surface", {1}};

    const ListFormat volume_list = {"Materials/Volumes",
                                    "not the material of a volume",
                                    "volume: Young modulus, Poisson ratio, density, alpha, beta; volume: ... [Pa, -, kg/m^3, 1/s, s], "
                                    "or without alpha and beta",
                                    "volume",
                                    {3, 5}};

    void declare_material(Declarations &declarations, const std::string &section, Material &material)
    {
      declarations.enter(section);
      declarations.add("Young modulus", material.young_modulus, "Pa", "Young's modulus E.", {0.});
      declarations.add("Poisson ratio", material.poisson_ratio, "none", "Poisson's ratio.", {-1., 0.5});
      declarations.add("Density", material.density, "kg/m^3", "Mass density.", {0.});
      declarations.add("Rayleigh alpha", material.rayleigh_alpha, "1/s",
                       "Damping in proportion to the mass, C = alpha M + beta K: modes of omega are damped by the ratio alpha / (2 "
                       "omega).",
                       {0.});
      declarations.add("Rayleigh beta", material.rayleigh_beta, "s",
                       "Damping in proportion to the stiffness of the material, mounts excluded: modes of omega are damped by the ratio "
                       "beta omega / 2.",
                       {0.});
    }

    void check_material(const std::string &section, const Material &material)
    {
      const auto require = [&](const bool is_fine, const std::string &what, const char *name, const char *change) {
        if (!is_fine)
          throw ParameterError(what, "parameter " + section + "/" + name, change);
      };
      require(material.young_modulus > 0., "Young's modulus is " + exact_text(material.young_modulus) + " Pa", "Young modulus",
              "give a positive value");
      require(material.poisson_ratio > -1. && material.poisson_ratio <= 0.4999, "Poisson's ratio is " + exact_text(material.poisson_ratio),
              "Poisson ratio", "give a value above -1 and up to 0.4999 (the stiffness of an incompressible material is infinite)");
      require(material.density > 0., "the density is " + exact_text(material.density) + " kg/m^3", "Density", "give a positive value");
      require(material.rayleigh_alpha >= 0. && std::isfinite(material.rayleigh_alpha),
              "the damping in proportion to the mass is " + exact_text(material.rayleigh_alpha) + " 1/s", "Rayleigh alpha",
              "give a finite value >= 0");
      require(material.rayleigh_beta >= 0. && std::isfinite(material.rayleigh_beta),
              "the damping in proportion to the stiffness is " + exact_text(material.rayleigh_beta) + " s", "Rayleigh beta",
              "give a finite value >= 0");
    }
  } // namespace

  bool Material::is_damped() const
  {
    return rayleigh_alpha != 0. || rayleigh_beta != 0.;
  }

  void MaterialParameters::declare(Declarations &declarations)
  {
    declare_material(declarations, "Disc material", disc);
    declare_material(declarations, "Pin material", pin);

    declarations.enter("Materials");
    declare_list(declarations, "Volumes", volumes,
                 "Volumes of other materials, such as a single pin, or the backplate of a pad, as a list `volume: Young modulus, Poisson "
                 "ratio, density, Rayleigh alpha, Rayleigh beta; ...`; without the last two they are not damped. Units: Pa, none, kg/m^3, "
                 "1/s, s.",
                 volume_list,
                 {&VolumeMaterial::young_modulus, &VolumeMaterial::poisson_ratio, &VolumeMaterial::density, &VolumeMaterial::rayleigh_alpha,
                  &VolumeMaterial::rayleigh_beta},
                 &VolumeMaterial::volume);

    declarations.enter("Mounts");
    declare_list(declarations, "Elastic mounts", mounts,
                 "Elastic foundations as a list `surface: radial, tangential, axial; ...`: named surface and its stiffness per "
                 "area in the directions of the disc's axis. Empty: the disc turns freely. Units: N/m^3.",
                 mount_list, {&Mount::radial, &Mount::tangential, &Mount::axial}, &Mount::surface);
    declare_list(declarations, "Dashpots", dashpots,
                 "Viscous dampers between surfaces and the ground as a list `surface: radial, tangential, axial; ...`: named surface "
                 "and its damping coefficient per area in the directions of the disc's axis. They hold nothing at rest. Units: N s/m^3.",
                 dashpot_list, {&Mount::radial, &Mount::tangential, &Mount::axial}, &Mount::surface);
    declare_list(declarations, "Added masses", masses,
                 "Masses that move with surfaces, such as those of shims, clips or a piston, as a list `surface: mass; ...`: named surface "
                 "and mass per area. Units: kg/m^2.",
                 mass_list, {&SurfaceMass::mass}, &SurfaceMass::surface);
  }

  void MaterialParameters::check() const
  {
    for (const auto &[section, material] : all())
      check_material(section, material);
    const auto check_mounts = [](const std::vector<Mount> &list, const std::string &name, const std::string &quantity, const char *unit) {
      for (const Mount &mount : list)
        for (const double value : {mount.radial, mount.tangential, mount.axial})
          if (!(value >= 0.) || !std::isfinite(value))
            throw ParameterError("the " + quantity + ' ' + exact_text(value) + ' ' + unit + " is not a finite value >= 0",
                                 "parameter Mounts/" + name + ", surface " + legible(mount.surface),
                                 "give zero or a positive " + quantity + " per area");
    };
    check_mounts(mounts, "Elastic mounts", "stiffness", "N/m^3");
    check_mounts(dashpots, "Dashpots", "damping coefficient", "N s/m^3");
    for (const SurfaceMass &mass : masses)
      check_mounts({{mass.surface, mass.mass, 0., 0.}}, "Added masses", "mass", "kg/m^2");
  }

  bool is_of_disc(const std::string &volume)
  {
    return volume == "disc" || volume.rfind("disc_", 0) == 0;
  }

  Material MaterialParameters::of(const std::string &volume) const
  {
    for (const VolumeMaterial &own : volumes)
      if (own.volume == volume)
        return own;
    return is_of_disc(volume) ? disc : pin;
  }

  bool MaterialParameters::has_own(const std::string &volume) const
  {
    return std::any_of(volumes.begin(), volumes.end(), [&](const VolumeMaterial &own) { return own.volume == volume; });
  }

  bool MaterialParameters::is_damped() const
  {
    const auto materials = all();
    return std::any_of(materials.begin(), materials.end(), [](const auto &entry) { return entry.second.is_damped(); });
  }

  std::vector<Material *> MaterialParameters::each()
  {
    std::vector<Material *> result = {&disc, &pin};
    for (VolumeMaterial &own : volumes)
      result.push_back(&own);
    return result;
  }

  std::vector<std::pair<std::string, Material>> MaterialParameters::all() const
  {
    std::vector<std::pair<std::string, Material>> result = {{"Disc material", disc}, {"Pin material", pin}};
    for (const VolumeMaterial &own : volumes)
      result.emplace_back("Materials/Volumes, " + own.volume, own);
    return result;
  }

  std::vector<double *> MaterialParameters::mount_values()
  {
    std::vector<double *> values;
    for (std::vector<Mount> *list : {&mounts, &dashpots})
      for (Mount &mount : *list)
        values.insert(values.end(), {&mount.radial, &mount.tangential, &mount.axial});
    for (SurfaceMass &mass : masses)
      values.push_back(&mass.mass);
    return values;
  }

  std::vector<std::string> MaterialParameters::mounted_surfaces() const
  {
    std::vector<std::string> names;
    const auto               add = [&names](const std::string &surface) {
      if (std::find(names.begin(), names.end(), surface) == names.end())
        names.push_back(surface);
    };
    for (const std::vector<Mount> *list : {&mounts, &dashpots})
      for (const Mount &mount : *list)
        add(mount.surface);
    for (const SurfaceMass &mass : masses)
      add(mass.surface);
    return names;
  }

  namespace
  {
    const ListFormat ratio_list = {"Damping/Modal damping ratio",
                                   "not a frequency with its damping ratio",
                                   "frequency: ratio, frequency: ratio, ... [Hz, -]",
                                   "",
                                   {2},
                                   ',',
                                   ':'};
  } // namespace

  double DampingParameters::modal_ratio(const double frequency) const
  {
    if (modal_ratios.empty())
      return 0.;
    const auto above = std::upper_bound(modal_ratios.begin(), modal_ratios.end(), frequency,
                                        [](const double f, const ModalDampingRatio &entry) { return f < entry.frequency; });
    if (above == modal_ratios.begin())
      return above->ratio;
    const ModalDampingRatio &below = *(above - 1);
    if (above == modal_ratios.end())
      return below.ratio;
    return below.ratio + (above->ratio - below.ratio) * (frequency - below.frequency) / (above->frequency - below.frequency);
  }

  void DampingParameters::declare(Declarations &declarations)
  {
    declarations.enter("Damping");
    declare_list(declarations, "Modal damping ratio", modal_ratios,
                 "Damping ratios of the real coupled modes as a list `frequency: ratio, ...` over ascending frequencies, linear in "
                 "between and constant beyond the ends. Empty: none. Units: Hz and none.",
                 ratio_list, {&ModalDampingRatio::frequency, &ModalDampingRatio::ratio});
  }

  void DampingParameters::check() const
  {
    const std::string where = std::string("parameter ") + ratio_list.parameter;
    for (const ModalDampingRatio &entry : modal_ratios)
      {
        if (!(entry.frequency >= 0.) || !std::isfinite(entry.frequency))
          throw ParameterError("the frequency " + exact_text(entry.frequency) + " Hz is not a finite value >= 0", where,
                               "give frequencies that are not negative");
        if (!(entry.ratio >= 0. && entry.ratio < 1.))
          throw ParameterError("the damping ratio " + exact_text(entry.ratio) + " at " + exact_text(entry.frequency) +
                                 " Hz is not in [0, 1)",
                               where, "give a ratio of the critical damping, 0.01 for one per cent");
        if (&entry != &modal_ratios.front() && !(entry.frequency > (&entry - 1)->frequency))
          throw ParameterError("the frequency " + exact_text(entry.frequency) + " Hz does not exceed the one before it, " +
                                 exact_text((&entry - 1)->frequency) + " Hz",
                               where, "give each frequency once, in ascending order");
      }
  }
} // namespace Squeal
