"""Contact problems of others and of our own: files in, solutions judged by their residual out.

    file ──► read ──► ContactProblem ──► solve ──► residual ──► comparison
           siconos, fclib, reduction
A problem is `u = W r + q` with Coulomb friction at every contact, see `engine.contact_problem`.
"""
