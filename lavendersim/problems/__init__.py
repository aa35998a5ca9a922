"""Contact problems by themselves, of benchmark files or of scenes: read, solved, judged, compared.

    file ──► read ──► ContactProblem ──► solve ──► residual ──► comparison
           siconos, fclib, reduced_problem
A problem is `u = W r + q` with Coulomb friction at every contact, see `engine.contact_problem`.
"""
