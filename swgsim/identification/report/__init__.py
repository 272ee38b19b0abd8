"""The answer: verdict, report.json, page, pictures, the next experiment, and the command."""
