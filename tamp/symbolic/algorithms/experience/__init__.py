"""Learn from stream calls: success statistics, prices of what fails, failure counts."""
