"""The sections of the package's results, by subject: one file a kind of result, or a section that several share."""
