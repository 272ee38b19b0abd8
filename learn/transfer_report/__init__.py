"""The report of the transfer study: ``report/transfer.html`` and ``transfer.json`` from finished runs in MLflow.

``runs`` collects the runs; ``tables``, ``studies``, ``confidence`` and ``importance`` compute; ``figures`` draws;
``sentences`` words the first lines; ``transfer_study`` writes both files. The subpackage exports nothing.

A new section takes four steps:

1. Add its study to ``runs.EXPERIMENTS`` or ``runs.PAPER_EXPERIMENTS``, with the experiments that make it.
2. Write a function in ``studies`` from its runs to a DataFrame of text. Names of columns have the units.
3. Add the DataFrame to the dictionary of ``transfer_study.studies_of``, only if the study was run.
4. Add title and block to ``transfer_page.html.jinja``, with its macros ``table(frame, title, note)``,
   ``figure(png, title, caption)`` and ``missing(study)``, which names the commands of a study without runs.
"""
