#include "solvers/libraries/nlopt_algorithms.hpp"

namespace odobench {

// Left out: NLopt's NEWUOA with bounds (its subproblem, an MMA run without limit or stop, may never return;
// the one without bounds runs on folded coordinates instead), LBFGS_NOCEDAL (not built into 2.7.1), and the
// AUGLAG family (an augmented Lagrangian of constraints other than bounds, which no problem here has). The
// MLSL variants with built-in choice of the local method are the two MLSL rows with local=...
const std::vector<NloptAlgorithm>& nlopt_algorithms() {
  static const std::vector<NloptAlgorithm> table = [] {
    std::vector<NloptAlgorithm> rows;
    const auto add = [&rows](const char* name, nlopt_algorithm id, const char* summary) -> NloptAlgorithm& {
      rows.push_back({});
      rows.back().name = name;
      rows.back().id = id;
      rows.back().summary = summary;
      return rows.back();
    };
    const auto gradient = [&add](const char* name, nlopt_algorithm id,
                                 const char* summary) -> NloptAlgorithm& {
      NloptAlgorithm& row = add(name, id, summary);
      row.gradient = true;
      return row;
    };
    const auto simple = [&add](const char* name, nlopt_algorithm id, const char* summary) -> NloptAlgorithm& {
      NloptAlgorithm& row = add(name, id, summary);
      row.step = true;
      return row;
    };
    const auto global = [&add](const char* name, nlopt_algorithm id, const char* summary,
                               bool stochastic) -> NloptAlgorithm& {
      NloptAlgorithm& row = add(name, id, summary);
      row.global = true;
      row.stochastic = stochastic;
      return row;
    };
    gradient("slsqp", NLOPT_LD_SLSQP, "sequential quadratic programming (Kraft 1994)");
    gradient("lbfgs", NLOPT_LD_LBFGS, "limited-memory BFGS (Nocedal 1980, Luksan)").memory = true;
    gradient("tnewton", NLOPT_LD_TNEWTON, "truncated Newton (Dembo, Steihaug 1983)").memory = true;
    gradient("tnewton-restart", NLOPT_LD_TNEWTON_RESTART, "truncated Newton, steepest-descent restarts")
        .memory = true;
    gradient("tnewton-precond", NLOPT_LD_TNEWTON_PRECOND, "truncated Newton, BFGS preconditioner").memory =
        true;
    gradient("tnewton-precond-restart", NLOPT_LD_TNEWTON_PRECOND_RESTART,
             "truncated Newton, BFGS preconditioner, restarts")
        .memory = true;
    gradient("var1", NLOPT_LD_VAR1, "shifted limited-memory variable metric, rank 1 (Vlcek, Luksan 2006)")
        .memory = true;
    gradient("var2", NLOPT_LD_VAR2, "shifted limited-memory variable metric, rank 2").memory = true;
    gradient("mma", NLOPT_LD_MMA, "method of moving asymptotes (Svanberg 2002)");
    gradient("ccsaq", NLOPT_LD_CCSAQ,
             "conservative convex separable quadratic approximation (Svanberg 2002)");
    simple("bobyqa", NLOPT_LN_BOBYQA, "derivative-free quadratic models in a box (Powell 2009)");
    {
      NloptAlgorithm& row =
          simple("newuoa", NLOPT_LN_NEWUOA, "derivative-free quadratic models, bounds folded (Powell 2004)");
      row.scalar_step = row.not_for_one = row.folded = true;
    }
    simple("cobyla", NLOPT_LN_COBYLA, "derivative-free linear models (Powell 1994)");
    simple("neldermead", NLOPT_LN_NELDERMEAD, "Nelder-Mead simplex with bounds (Box 1965)");
    simple("sbplx", NLOPT_LN_SBPLX, "Nelder-Mead on subspaces (Rowan 1990)");
    {
      NloptAlgorithm& row =
          simple("praxis", NLOPT_LN_PRAXIS, "principal axes (Brent 1972), infinite cost outside the box");
      row.stochastic = row.scalar_step = true;
    }
    global("crs2", NLOPT_GN_CRS2_LM, "controlled random search with local mutation (Kaelo, Ali 2006)", true)
        .population = true;
    global("isres", NLOPT_GN_ISRES, "evolution strategy (Runarsson, Yao 2005)", true).population = true;
    global("esch", NLOPT_GN_ESCH, "evolutionary algorithm (da Silva Santos 2010)", true).population = true;
    global("direct", NLOPT_GN_DIRECT, "dividing rectangles (Jones 1993)", false);
    global("direct-l", NLOPT_GN_DIRECT_L, "dividing rectangles, locally biased (Gablonsky 2001)", false);
    global("direct-l-rand", NLOPT_GN_DIRECT_L_RAND, "locally biased DIRECT with random sides", true);
    global("direct-noscal", NLOPT_GN_DIRECT_NOSCAL, "DIRECT without NLopt's scaling", false);
    global("direct-l-noscal", NLOPT_GN_DIRECT_L_NOSCAL, "DIRECT-L without NLopt's scaling", false);
    global("direct-l-rand-noscal", NLOPT_GN_DIRECT_L_RAND_NOSCAL, "DIRECT-L-RAND without NLopt's scaling",
           true);
    global("direct-orig", NLOPT_GN_ORIG_DIRECT, "DIRECT, Gablonsky's code", false).late_stop = true;
    global("direct-l-orig", NLOPT_GN_ORIG_DIRECT_L, "DIRECT-L, Gablonsky's code", false).late_stop = true;
    for (const bool random : {false, true}) {
      NloptAlgorithm& row =
          global(random ? "stogo-rand" : "stogo", random ? NLOPT_GD_STOGO_RAND : NLOPT_GD_STOGO,
                 random ? "StoGO with random starts"
                        : "branch and bound with local searches (Madsen, Zertchaninov 1998)",
                 random);
      row.gradient = row.statics = true;
      row.population = random;
    }
    {
      NloptAlgorithm& row =
          global("ags", NLOPT_GN_AGS, "index algorithm on a space-filling curve (Strongin, Sergeyev)", false);
      row.statics = true;
      row.most_parameters = 10;
    }
    for (const bool sobol : {false, true}) {
      NloptAlgorithm& row = global(
          sobol ? "mlsl-lds" : "mlsl", sobol ? NLOPT_G_MLSL_LDS : NLOPT_G_MLSL,
          sobol ? "MLSL with Sobol points" : "multi-level single linkage (Rinnooy Kan, Timmer 1987)", !sobol);
      row.local = row.population = row.step = true;
    }
    return rows;
  }();
  return table;
}

}  // namespace odobench
