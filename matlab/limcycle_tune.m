function result = limcycle_tune (what, varargin)
% LIMCYCLE_TUNE  Numbers within bounds that end hunting.
%   RESULT = LIMCYCLE_TUNE (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('tune', what, varargin{:});
end
